// Set-up of the projected kernel.
#include "kernels/projected.hpp"

namespace talus {
namespace {

template <int D>
MaxentValues value_rows(const Mesh<D>& mesh, const ProjectedOptions& options)
{
  switch (options.values) {
    case ValueStencil::l2: return {l2_values(mesh), {}};
    case ValueStencil::mls: return {mls_values(mesh, options.alpha), {}};
    case ValueStencil::maxent: break;
  }
  return maxent_values(mesh, options.alpha);
}

}  // namespace

template <int D>
Projected<D>::Projected(const Mesh<D>& mesh, const Options& options) : Projected(mesh, options.values, value_rows(mesh, options))
{}

template <int D>
Projected<D>::Projected(const Mesh<D>& mesh, ValueStencil values, MaxentValues rows)
    : hats_(mesh), values_(values), as_corners_(std::move(rows.as_corners)), node_part_(mesh, std::move(rows.S), averaged_gradients(mesh))
{}

template class Projected<2>;
template class Projected<3>;

}  // namespace talus
