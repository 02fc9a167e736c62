#pragma once
// Checks whether a state read from a file is valid for a run: the values, not their number.
#include <string>
#include <vector>

#include "materials/interface/material.hpp"
#include "solver/model/model.hpp"

namespace talus {

/// Adds the impossible values of a clock to `faults`, in words.
void find_invalid(const Clock& clock, std::vector<std::string>& faults);
void find_invalid(const StageState& stage, const Clock& now, std::vector<std::string>& faults);
/// Adds the invalid terms of a balance; errors are relative to the largest of them.
void find_invalid(const EnergyLedger& energy, std::vector<std::string>& faults);
/// Adds the first particle with each kind of fault.  Bodies, histories and rows of columns must be consistent.
template <int D>
void find_invalid(const Particles<D>& particles, const std::vector<Body>& bodies, const std::vector<Material>& materials,
                  std::vector<std::string>& faults);

}  // namespace talus
