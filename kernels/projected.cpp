// Set-up of the projected kernel.
#include "kernels/projected.hpp"

namespace talus {

namespace {

/// Prior weight of the neighbours of a node relative to its own [-].
constexpr Real weight_of_neighbours = 0.5;

}  // namespace

template <int D>
Projected<D>::Projected(const Mesh<D>& mesh, const Options& options) : Projected(mesh, maxent_values(mesh, weight_of_neighbours))
{
  extends_ = options.surfaces == AtSurfaces::extended;
}

template <int D>
Projected<D>::Projected(const Mesh<D>& mesh, MaxentValues rows)
    : linear_(mesh), as_corners_(std::move(rows.as_corners)), node_part_(mesh, std::move(rows.S), averaged_gradients(mesh))
{}

template class Projected<2>;
template class Projected<3>;

}  // namespace talus
