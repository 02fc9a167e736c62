// The command talus check --variants.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "app/commands/check_command.hpp"
#include "app/run/simulate.hpp"
#include "app/run/summary.hpp"
#include "app/setup/quick.hpp"
#include "core/version.hpp"
#include "io/document/document.hpp"
#include "io/load_mesh.hpp"
#include "io/output/variants_json.hpp"
#include "io/scene/reader.hpp"
#include "mesh/digest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The changes that affect the mesh.
std::string mesh_changes(const Variant& variant)
{
  std::string text;
  for (const std::string& change : variant.changes)
    for (const std::string_view block : {"mesh", "accuracy", "dimension"})
      if (is_within(std::string_view(change).substr(0, change.find('=')), block))
        text += change + '\n';
  return text;
}

class VariantChecks {
 public:
  VariantChecks(fs::path scene, VariantsAsked asked) : scene_(std::move(scene)), asked_(std::move(asked)), found_(asked_.variants.size()) {}

  std::vector<VariantFound> operator()()
  {
    std::map<std::string, std::vector<std::size_t>> by_mesh;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      const Variant& variant = asked_.variants[i];
      try {
        const Scene scene = read_scene(scene_, variant.changes);
        found_[i].scene_digest = scene_digest(scene);
        for (const FrontSpec& front : scene.outputs.history ? scene.outputs.history->fronts : std::vector<FrontSpec>{})
          found_[i].fronts.push_back(front.name);
        by_mesh[fmt::format("{}-D\n{}", scene.dimension, mesh_changes(variant))].push_back(i);
      } catch (const SceneErrors& e) {
        found_[i].errors = e.problems();
      }
    }
    if (asked_.depth == CheckDepth::scenes)
      return found_;
    for (const auto& [changes, variants] : by_mesh)
      if (changes.starts_with('2'))
        check_on_mesh<2>(variants);
      else
        check_on_mesh<3>(variants);
    return found_;
  }

 private:
  Scene scene_of(std::size_t i) const
  {
    Scene scene = read_scene(scene_, asked_.variants[i].changes);
    if (asked_.quick)
      coarsen(scene);
    return scene;
  }

  /// Builds the models of variants with a common mesh, which is made once.
  template <int D>
  void check_on_mesh(const std::vector<std::size_t>& variants)
  {
    std::optional<Mesh<D>> mesh;
    try {
      const Scene scene = scene_of(variants.front());
      mesh.emplace(load_mesh<D>(scene, folder_of(scene)));
    } catch (const SceneErrors& e) {
      for (const std::size_t i : variants)
        found_[i].errors = e.problems();
      return;
    }
    const std::string mesh_digest = digest_text(digest(*mesh));
    Real volume = 0;
    for (Index c = 0; c < mesh->n_cells(); ++c)
      volume += mesh->volume(c);
    const Real cell_size = std::pow(volume / static_cast<Real>(mesh->n_cells()), Real{1} / D);
    for (const std::size_t i : variants) {
      found_[i].mesh_digest = mesh_digest, found_[i].cells = mesh->n_cells(), found_[i].cell_size = cell_size;
      if (asked_.depth == CheckDepth::meshes || asked_.variants[i].built_on == mesh_digest)
        continue;
      try {
        const Scene scene = scene_of(i);
        Setup<D> setup = set_up(scene, *mesh);
        found_[i].particles = setup.n_particles;
        estimate<D>(scene, *mesh, std::move(setup));
      } catch (const SceneErrors& e) {
        found_[i].errors = e.problems();
      }
    }
  }

  fs::path scene_;
  VariantsAsked asked_;
  std::vector<VariantFound> found_;
};

}  // namespace

void check_variants(const fs::path& scene, const fs::path& variants)
{
  VariantChecks checks(scene, read_variants(variants));
  fmt::print("{}", variants_text(std::string(version().commit), checks()));
}

}  // namespace talus
