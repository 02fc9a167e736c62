#include "io/scene/law_libraries.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "io/output/output_fields.hpp"
#include "io/python/python_law.hpp"
#include "io/system/law_library.hpp"
#include "materials/interface/law_variant.hpp"
#include "materials/interface/umat.hpp"

namespace talus {

namespace {

/// Throws Error for a history variable that would be taken for something else in files: those of a name are one field, of one form.
void check_names(const LawDescription& description, std::span<const LawDescription* const> others)
{
  for (const HistoryVariable& variable : description.variables) {
    bool taken = false;
    for_each_quantity(particle_fields(), [&](const auto& field) { taken = taken || field.name == variable.key; });
    if (taken)
      throw Error(fmt::format("the history variable \"{}\" of the law {} has the name of a field of all particles", variable.key,
                              description.name));
    std::vector<const LawDescription*> laws = known_laws();
    laws.insert(laws.end(), others.begin(), others.end());
    for (const LawDescription* law : laws)
      for (const HistoryVariable& other : law->variables)
        if (other.key == variable.key && (other.components != variable.components || other.unit != variable.unit))
          throw Error(fmt::format("the history variable \"{}\" of the law {} has {} components of the unit {}, and that of {} has {} of {}",
                                  variable.key, description.name, variable.components, variable.unit, law->name, other.components,
                                  other.unit));
  }
}

class Opener {
 public:
  Opener(const std::filesystem::path& scene_file, std::string path, std::span<const LawDescription* const> others)
      : folder_(scene_file.parent_path()), path_(std::move(path)), others_(others)
  {}

  std::vector<Finding> found() && { return std::move(findings_); }

  void open(LawBySymbol& law)
  {
    if (law.symbol.empty())
      return add("symbol", "it is empty: the name of the function that returns the law");
    const std::shared_ptr<const OwnLawCode> code = is_python(law) ? python_code(law) : library_code(law);
    if (!code)
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
      check_names(code->description(), others_);
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
  static bool is_python(const LawInLibrary& law) { return std::filesystem::path(law.library).extension() == ".py"; }
  std::shared_ptr<const OwnLawCode> checked_code(const talus_law& law, const LawInLibrary& from, const std::string& digest)
  {
    auto code = std::make_shared<const OwnLawCode>(law, OwnLawOrigin{from.library, digest, {}});
    check_names(code->description(), others_);
    return code;
  }
  /// The law of a shared library; nothing, and a finding, if it cannot be had.
  std::shared_ptr<const OwnLawCode> library_code(const LawBySymbol& law)
  {
    std::shared_ptr<const OwnLawCode> code;
    if (const auto library = library_of(law))
      attempt("symbol", [&] {
        using Describe = const talus_law* (*)();
        const auto describe = reinterpret_cast<Describe>(library->function(law.symbol));
        code = checked_code(described_law(describe, fmt::format("the function {} of {}", law.symbol, law.library)), law, library->digest());
      });
    return code;
  }
  /// The same in Python.
  std::shared_ptr<const OwnLawCode> python_code(const LawBySymbol& law)
  {
    std::shared_ptr<const OwnLawCode> code;
    if (law.density > 0)
      attempt("library", [&] {
        const std::filesystem::path file = folder_ / law.library;
        const std::string digest = digest_of_law_file(file);
        code = checked_code(*open_python_law(file.string(), law.symbol), law, digest);
      });
    return code;
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
  std::span<const LawDescription* const> others_;
  std::vector<Finding> findings_;
};

}  // namespace

std::vector<Finding> open_library(const std::filesystem::path& scene_file, const std::string& path, AnyLaw& law,
                                  std::span<const LawDescription* const> others)
{
  if (law.is_open())
    return {};
  Opener opener(scene_file, path, others);
  std::visit(
      [&]<class L>(L& of_user) {
        if constexpr (is_in_library<L>)
          opener.open(of_user);
      },
      law.edit_parameters().of);
  return std::move(opener).found();
}

}  // namespace talus
