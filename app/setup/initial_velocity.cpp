#include "app/setup/initial_velocity.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "app/setup/expression.hpp"

namespace talus {

template <int D>
void set_velocity(const BodySpec& spec, const Mesh<D>& mesh, Communicator& ranks, Index begin, Index end, SceneErrorCollector& errors,
                  Particles<D>& particles)
{
  if (spec.velocity.empty())
    return;
  const auto first = static_cast<std::size_t>(begin), count = static_cast<std::size_t>(end - begin);
  std::vector<Vec3> places(count, Vec3::Zero());
  std::vector<Real> sizes(count);  // of cells [m]
  for (std::size_t p = 0; p < count; ++p) {
    places[p].template head<D>() = particles.x[first + p];
    sizes[p] = std::pow(mesh.volume(particles.cell[first + p]), Real{1} / D);
  }
  for (int d = 0; d < D; ++d) {
    std::string wrong;
    try {
      const std::string& formula = spec.velocity[static_cast<std::size_t>(d)];
      const auto values = evaluate(formula, places);
      const auto slopes = gradients(formula, places, sizes);
      for (std::size_t p = 0; p < count; ++p) {
        Vec<D> v = particles.v[first + p];
        v[d] = values[p];
        particles.v.set(first + p, v);
        Mat<D> L = particles.L[first + p];
        L.row(d) = slopes[p].template head<D>();
        particles.L.set(first + p, L);
      }
    } catch (const std::invalid_argument& e) {
      wrong = e.what();
    }
    if (wrong = ranks.first(wrong); !wrong.empty())
      errors.add(spec.where, fmt::format("velocity[{}]", d), wrong);
  }
}

template void set_velocity<2>(const BodySpec&, const Mesh<2>&, Communicator&, Index, Index, SceneErrorCollector&, Particles<2>&);
template void set_velocity<3>(const BodySpec&, const Mesh<3>&, Communicator&, Index, Index, SceneErrorCollector&, Particles<3>&);

}  // namespace talus
