#pragma once
// Whether a state that a file holds is one that a run can go on from: what its numbers are, not how many.
#include <string>
#include <vector>

#include "materials/interface/material.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// Adds to `faults`, in words, what no sound run has.
void find_invalid(const Clock& clock, std::vector<std::string>& faults);
void find_invalid(const StageState& stage, const Clock& now, std::vector<std::string>& faults);
/// Errors are measured by the largest of these.
void find_invalid(const EnergyLedger& energy, std::vector<std::string>& faults);
/// Of each fault the first particle.  Bodies, histories and the rows of columns fit together.
template <int D>
void find_invalid(const Particles<D>& particles, const std::vector<Body>& bodies, const std::vector<Material>& materials,
                  std::vector<std::string>& faults);

extern template void find_invalid<2>(const Particles<2>&, const std::vector<Body>&, const std::vector<Material>&,
                                     std::vector<std::string>&);
extern template void find_invalid<3>(const Particles<3>&, const std::vector<Body>&, const std::vector<Material>&,
                                     std::vector<std::string>&);

}  // namespace talus
