#pragma once
// `--quick`: any scene coarse and short, to see that it runs.
#include "app/setup/setup.hpp"

namespace talus {

/// Steps that a quick run makes at most, about.
inline constexpr Real quick_steps = 200;

/// Cells twice as large, the fewest particles per cell that still integrate linear stress exactly.  Meshes from files stay as they are.
void coarsen(Scene& scene);

/// Stages cut in proportion so that about `quick_steps` steps of `dt` [s] are made; outputs four times a run at most; a geostatic stage
/// ends with its time, at rest or not.
void shorten(Real dt, std::vector<Stage>& stages, OutputSpec& outputs);

}  // namespace talus
