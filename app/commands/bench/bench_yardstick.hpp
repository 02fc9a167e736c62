#pragma once
// The yardstick of `talus bench`: the same swirl on a structured grid, in the shortest loop known, written with care.
#include "app/commands/bench/bench_measure.hpp"

namespace talus {

/// MLS-MPM (Hu et al. 2018, ACM Trans. Graph. 37, 150) with quadratic B-splines, affine velocities (Jiang et al. 2015) and neo-Hookean
/// rubber in double precision.  It knows squares and cubes, one material and walls along the sides, and keeps no accounts.
BenchResult measure_yardstick(int dimension, int n_threads, const BenchPlan& plan);

/// Particles in a square or a cube of its grid.
constexpr int yardstick_per_cell(int dimension) noexcept { return dimension == 2 ? 4 : 8; }

}  // namespace talus
