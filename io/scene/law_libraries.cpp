#include "io/scene/law_libraries.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "io/output/output_fields.hpp"
#include "io/system/law_library.hpp"
#include "materials/interface/law_variant.hpp"
#include "materials/interface/umat.hpp"

namespace talus {

namespace {

/// Throws Error for a history variable that would be taken for something else in files.
void check_names(const LawDescription& description)
{
  for (const HistoryVariable& variable : description.variables) {
    bool taken = false;
    for_each_quantity(particle_fields(), [&](const auto& field) { taken = taken || field.name == variable.key; });
    if (taken)
      throw Error(fmt::format("the history variable \"{}\" of the law {} has the name of a field of all particles", variable.key,
                              description.name));
    for (const LawDescription* law : known_laws())
      for (const HistoryVariable& other : law->variables)
        if (other.key == variable.key && other.components != variable.components)
          throw Error(fmt::format("the history variable \"{}\" of the law {} has {} components, and that of {} has {}", variable.key,
                                  description.name, variable.components, law->name, other.components));
  }
}

class Opener {
 public:
  Opener(const std::filesystem::path& scene_file, std::string path) : folder_(scene_file.parent_path()), path_(std::move(path)) {}

  std::vector<Finding> found() && { return std::move(findings_); }

  void open(LawBySymbol& law)
  {
    if (law.symbol.empty())
      return;
    const auto library = library_of(law);
    if (!library)
      return;
    std::shared_ptr<const OwnLawCode> code;
    attempt("symbol", [&] {
      using Describe = const talus_law* (*)();
      const auto describe = reinterpret_cast<Describe>(library->function(law.symbol));
      const talus_law* const described = describe();
      if (described == nullptr)
        throw Error(fmt::format("the function {} of {} returned no law", law.symbol, law.library));
      code = std::make_shared<const OwnLawCode>(*described, OwnLawOrigin{law.library, library->digest(), {}});
      check_names(code->description());
    });
    if (!findings_.empty())
      return;
    OwnLawValues values = values_of(*code, law.parameters);
    for (const OwnLawProblem& problem : values.problems)
      add(problem.name.empty() ? "parameters" : "parameters." + problem.name, problem.message);
    if (!findings_.empty())
      return;
    law.parameters.all.clear();
    for (std::size_t i = 0; i < values.values.size(); ++i)
      law.parameters.all.push_back({code->parameters()[i].key, values.values[i]});
    attempt("parameters", [&] { law.opened = own_law(code, std::move(values.values), law.density, law.serial); });
  }
  void open(UmatLaw& law)
  {
    const auto library = library_of(law);
    if (!library)
      return;
    attempt("symbol", [&] {
      const auto function = reinterpret_cast<UmatFunction>(library->function(law.symbol));
      const auto code = umat_code(function, law, {law.library, library->digest(), {}});
      check_names(code->description());
      law.opened = own_law(code, {}, law.density, law.serial);
    });
  }

 private:
  void add(const std::string& key, std::string message) { findings_.push_back({fmt::format("{}.{}", path_, key), std::move(message)}); }
  template <class F>
  void attempt(const std::string& key, F&& f)
  {
    try {
      f();
    } catch (const Error& wrong) {
      add(key, wrong.what());
    }
  }
  /// Nothing if it cannot be opened, or if the file gives no library or no density.
  std::optional<LawLibrary> library_of(const LawInLibrary& law)
  {
    std::optional<LawLibrary> library;
    if (!law.library.empty() && law.density > 0)
      attempt("library", [&] { library.emplace(folder_ / law.library); });
    return library;
  }

  std::filesystem::path folder_;
  std::string path_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> open_library(const std::filesystem::path& scene_file, const std::string& path, AnyLaw& law)
{
  if (law.is_open())
    return {};
  Opener opener(scene_file, path);
  std::visit(
      [&]<class L>(L& of_user) {
        if constexpr (is_in_library<L>)
          opener.open(of_user);
      },
      law.edit_parameters().of);
  return std::move(opener).found();
}

}  // namespace talus
