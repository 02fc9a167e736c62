#include "io/output/variants_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

using VariantsJson = nlohmann::ordered_json;

CheckDepth depth_of(const std::string& word)
{
  return word == "scenes" ? CheckDepth::scenes : word == "meshes" ? CheckDepth::meshes : CheckDepth::models;
}

}  // namespace

VariantsAsked read_variants(const std::filesystem::path& file)
try {
  const VariantsJson json = VariantsJson::parse(read_whole(file));
  VariantsAsked asked{.depth = depth_of(json.at("check").get<std::string>()), .quick = json.at("quick").get<bool>(), .variants = {}};
  for (const VariantsJson& variant : json.at("variants"))
    asked.variants.push_back({variant.at("set").get<std::vector<std::string>>(), variant.at("built_on").get<std::string>()});
  return asked;
} catch (const VariantsJson::exception& e) {
  throw Error(fmt::format("{} names no variants of a scene: {}", file.string(), e.what()));
}

std::string variants_text(const std::string& commit, const std::vector<VariantFound>& found)
{
  VariantsJson json{{"commit", commit}, {"variants", VariantsJson::array()}};
  for (const VariantFound& one : found) {
    VariantsJson errors = VariantsJson::array();
    for (const SceneError& error : one.errors)
      errors.push_back({{"file", error.where.file},
                        {"line", error.where.line},
                        {"column", error.where.column},
                        {"key", error.where.path},
                        {"text", error.message},
                        {"source", error.source_line}});
    json["variants"].push_back({{"scene_digest", one.scene_digest},
                                {"mesh_digest", one.mesh_digest},
                                {"fronts", one.fronts},
                                {"cells", one.cells},
                                {"cell_size [m]", one.cell_size},
                                {"particles", one.particles},
                                {"errors", std::move(errors)}});
  }
  return json.dump(-1, ' ', false, VariantsJson::error_handler_t::replace) + '\n';
}

}  // namespace talus
