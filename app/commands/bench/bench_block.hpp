#pragma once
// The block that `talus bench` runs: a jittered box, walls all around, filled by a body that swirls.
#include "app/run/simulate.hpp"
#include "io/output/bench_json.hpp"

namespace talus {

template <int D>
struct BenchBlock {
  Scene scene;
  Mesh<D> mesh;
  Setup<D> setup;
};

/// What a block may have besides, to see what it costs.
namespace bench_options {
inline constexpr std::string_view f_bar = "f_bar", friction = "friction", history = "history", bulk_viscosity = "bulk_viscosity",
                                  traction = "traction", body_force = "body_force",
                                  again = "nothing";  ///< measured once more: shows how far to trust differences
inline constexpr std::array<std::string_view, 8> each{"", f_bar, friction, bulk_viscosity, traction, body_force, history, again};
}  // namespace bench_options

/// About `particles` particles, for exactly `steps` steps.
template <int D>
BenchBlock<D> bench_block(const BenchSetting& setting, Index particles, int steps);

/// Cells along a side of a box of cubes (squares), each of which holds `per_cube` particles.
Index cells_a_side(int dimension, Index particles, int per_cube);

/// Speed of the swirl over that of waves [-].
inline constexpr Real bench_swirl = 0.08;
/// Length of a step as a share of the stable one.
inline constexpr Real bench_cfl = 0.4;

}  // namespace talus
