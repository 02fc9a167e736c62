#pragma once
// The block `boundaries` of a scene -> walls.
#include "app/setup/cell_occupancy.hpp"
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// Adds the walls of a stage, called by its name.  Of the `first` stage it is told what is worth a word: notes and warnings of `setup`.  Every rank
/// has to ask.
template <int D>
void add_walls(const Scene& scene, const Mesh<D>& mesh, const Filled<D>& has_particles, Exchange& ranks, const std::string& stage,
               bool first, Complaints& complaints, Setup<D>& setup, Walls<D>& walls);

extern template void add_walls<2>(const Scene&, const Mesh<2>&, const Filled<2>&, Exchange&, const std::string&, bool, Complaints&,
                                  Setup<2>&, Walls<2>&);
extern template void add_walls<3>(const Scene&, const Mesh<3>&, const Filled<3>&, Exchange&, const std::string&, bool, Complaints&,
                                  Setup<3>&, Walls<3>&);

}  // namespace talus
