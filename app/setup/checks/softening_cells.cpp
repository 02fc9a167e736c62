#include "app/setup/checks/softening_cells.hpp"

#include <fmt/format.h>

#include "core/parallel/exact_sum.hpp"

namespace talus {

namespace {

/// The fewest with which the width of a band was measured to be right, see benchmarks/softening_band.
constexpr Real cells_of_a_band = 6;

/// Mean length of the edges of a cell [m].
template <int D>
Real mean_edge(const Mesh<D>& mesh, Index cell)
{
  const auto& nodes = mesh.cell(cell);
  Real sum = 0;
  for (std::size_t a = 0; a <= D; ++a)
    for (std::size_t b = 0; b < a; ++b)
      sum += (mesh.node(nodes[a]) - mesh.node(nodes[b])).norm();
  return sum / (D * (D + 1) / 2);
}

}  // namespace

template <int D>
void warn_of_coarse_cells(const Scene& scene, const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                          const std::vector<Material>& materials, Communicator& ranks, std::vector<std::string>& warnings)
{
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    const auto averaging = materials[body].law().strain_averaging();
    if (!averaging)
      continue;
    ExactSums<Real> edges;
    for (Index row = bodies[body].begin; row < bodies[body].end; ++row)
      edges.add(mean_edge(mesh, particles.cell[static_cast<std::size_t>(row)]));
    const std::int64_t count = ranks.sum(std::int64_t{bodies[body].end - bodies[body].begin});
    ranks.sum(edges);
    const Real edge = edges.value() / static_cast<Real>(count);
    if (count > 0 && averaging->band < cells_of_a_band * edge)
      warnings.push_back(fmt::format(
          "{}: body \"{}\" has cells of {:.3g} m where bands of failure are {:.3g} m wide by its softening_length: they need six "
          "cells or more to be as wide on any mesh; take cells of at most {:.3g} m where it fails",
          to_string(scene.bodies[body].where), bodies[body].name, edge, averaging->band, averaging->band / cells_of_a_band));
  }
}

template void warn_of_coarse_cells(const Scene&, const Mesh<2>&, const Particles<2>&, const std::vector<Body>&,
                                   const std::vector<Material>&, Communicator&, std::vector<std::string>&);
template void warn_of_coarse_cells(const Scene&, const Mesh<3>&, const Particles<3>&, const std::vector<Body>&,
                                   const std::vector<Material>&, Communicator&, std::vector<std::string>&);

}  // namespace talus
