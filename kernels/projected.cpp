// Set-up of the projected kernel.
#include "kernels/projected.hpp"

namespace talus {
namespace {

template <int D>
std::vector<Real> value_rows(const Mesh<D>& mesh, const ProjectedOptions& options)
{
  switch (options.values) {
    case ValueStencil::l2: return l2_values(mesh);
    case ValueStencil::mls: return mls_values(mesh, options.alpha);
    case ValueStencil::maxent: break;
  }
  return maxent_values(mesh, options.alpha);
}

}  // namespace

template <int D>
Projected<D>::Projected(const Mesh<D>& mesh, const Options& options)
    : hats_(mesh), values_(options.values), node_part_(mesh, value_rows(mesh, options), averaged_gradients(mesh))
{}

template class Projected<2>;
template class Projected<3>;

}  // namespace talus
