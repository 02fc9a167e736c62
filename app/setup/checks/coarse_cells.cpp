#include "app/setup/checks/coarse_cells.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/parallel/exact_sum.hpp"
#include "materials/interface/varied_law.hpp"

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

/// From about this excess of the strength of cells on, shares of slopes that fail were found to depend on the cells, see
/// benchmarks/random_slope.
constexpr Real largest_unevenness = 0.05;

/// How uneven values are within cells: between places half an edge apart.
template <int D>
Real unevenness_in_cells(const ParameterVariation& variation, Real edge)
{
  Vec3 apart = Vec3::Zero();
  apart.head<D>().setConstant(edge / 2 / std::sqrt(D));
  return variation.unevenness(apart);
}

template <int D>
void warn_of_uneven_cells(const std::string& body, const VariedLaw& law, Real edge, std::vector<std::string>& warnings)
{
  for (const ParameterVariation& one : law.variation()) {
    const Real unevenness = unevenness_in_cells<D>(one, edge);
    if (unevenness <= largest_unevenness)
      continue;
    Real enough = edge;
    while (unevenness_in_cells<D>(one, enough) > largest_unevenness)
      enough *= 0.99;
    warnings.push_back(fmt::format(
        "{}: {} varies within the cells of {:.3g} m of body \"{}\": their mean is about {:.0f} % above the geometric mean, which counts "
        "along a slip surface; if it is a strength, failure may be found too seldom (unsafe): take cells of at most {:.2g} m where it "
        "fails",
        to_string(one.where), one.parameter, edge, body, 100 * unevenness, enough));
  }
}

}  // namespace

template <int D>
void warn_of_coarse_cells(const Scene& scene, const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                          const std::vector<Material>& materials, Communicator& ranks, std::vector<std::string>& warnings)
{
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    const auto averaging = materials[body].law().strain_averaging();
    const auto* const varied = dynamic_cast<const VariedLaw*>(&materials[body].law());
    if (!averaging && varied == nullptr)
      continue;
    ExactSums<Real> edges;
    for (Index row = bodies[body].begin; row < bodies[body].end; ++row)
      edges.add(mean_edge(mesh, particles.cell[static_cast<std::size_t>(row)]));
    const std::int64_t count = ranks.sum(std::int64_t{bodies[body].end - bodies[body].begin});
    ranks.sum(edges);
    const Real edge = edges.value() / static_cast<Real>(count);
    if (count == 0)
      continue;
    if (varied != nullptr)
      warn_of_uneven_cells<D>(bodies[body].name, *varied, edge, warnings);
    if (averaging && averaging->band < cells_of_a_band * edge)
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
