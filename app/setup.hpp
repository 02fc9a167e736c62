#pragma once
// Scene + Mesh -> everything a model is made of that does not depend on the kernel.
#include <filesystem>

#include "io/scene.hpp"
#include "solver/run.hpp"

namespace talus {

template <int D>
struct Setup {
  Particles<D> particles;
  std::vector<Body> bodies;
  std::vector<AnyBatch> materials;
  Walls<D> walls;
  Loads<D> loads;
  Transfer transfer;
  Exits exits;
  std::vector<Stage> stages;
  StepLimits limits;
  std::vector<std::string> warnings;
};

/// Throws SceneErrors with everything that is wrong: groups the mesh does not have, bodies without particles, loads on nothing.
/// Particles stand in the order of body, cell and id; ids are 0, 1, 2, ... in that order.
template <int D>
Setup<D> set_up(const Scene& scene, const Mesh<D>& mesh);

/// The scheme of a scene, with the defaults that go with it.
Transfer transfer_of(const TransferSpec& spec);

/// Folder of relative paths in the scene.
std::filesystem::path folder_of(const Scene& scene);

extern template Setup<2> set_up<2>(const Scene&, const Mesh<2>&);
extern template Setup<3> set_up<3>(const Scene&, const Mesh<3>&);

}  // namespace talus
