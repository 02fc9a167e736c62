// talus check
#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/simulate.hpp"
#include "io/gmsh_mesh.hpp"
#include "io/reader.hpp"

namespace talus {

namespace {

template <int D>
void check(const Scene& scene)
{
  auto mesh = load_mesh<D>(scene.mesh, folder_of(scene));
  auto setup = set_up(scene, mesh);
  const auto warnings = setup.warnings;
  const Index particles = setup.particles.size(), cells = mesh.n_cells(), nodes = mesh.n_nodes();
  std::string bodies;
  for (const Body& body : setup.bodies)
    bodies += fmt::format("  body \"{}\": {} particles\n", body.name, body.size());
  if (setup.origin)
    bodies += describe(*setup.origin);
  const Estimate cost = estimate(scene, std::move(mesh), std::move(setup));
  for (const std::string& warning : warnings)
    fmt::print(stderr, "warning: {}\n", warning);
  constexpr Real mega = 1e6;
  fmt::print("{}\n  {}-D, kernel {}, {} cells, {} nodes, {} particles\n{}", scene.title, D, scene.kernel, cells, nodes, particles, bodies);
  fmt::print("  first step {:.3g} s, so about {} steps and {:.3g} million particle-steps\n", cost.dt, cost.steps,
             static_cast<Real>(cost.steps) * particles / mega);
  fmt::print("  memory: particles {:.1f} MB, mesh {:.1f} MB, nodes {:.1f} MB\n", static_cast<Real>(cost.particle_bytes) / mega,
             static_cast<Real>(cost.mesh_bytes) / mega, static_cast<Real>(cost.node_bytes) / mega);
  fmt::print("{}: no errors\n", scene.file);
}

}  // namespace

void check_scene(const std::filesystem::path& file, const std::vector<std::string>& set)
{
  const Scene scene = read_scene(file, set);
  if (scene.dimension == 2)
    check<2>(scene);
  else
    check<3>(scene);
}

}  // namespace talus
