#pragma once
// How long a run would take, from a few steps of it.
#include "app/run/simulate.hpp"

namespace talus {

/// Some steps of a stage, made from the state at the start of the run.
struct StageTrial {
  std::string name;
  std::size_t stage;              ///< its number
  Real dt;                        ///< their mean length [s]
  Real quickest, usual, slowest;  ///< the median of their wall times and the quartiles around it [s]
  std::int64_t made;              ///< steps made
};

/// The first steps of each stage, in memory, one stage after the other; nothing is written.  A stage is left where a step fails: then those
/// before it count, and RunError passes through if there were none.
template <int D>
std::vector<StageTrial> try_stages(const Scene& scene, Mesh<D> mesh, Setup<D> setup);

extern template std::vector<StageTrial> try_stages<2>(const Scene&, Mesh<2>, Setup<2>);
extern template std::vector<StageTrial> try_stages<3>(const Scene&, Mesh<3>, Setup<3>);

}  // namespace talus
