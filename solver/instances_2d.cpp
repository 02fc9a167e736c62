// The step of every kernel in 2-D, compiled once.
#include "solver/instances.hpp"

namespace talus {

template void advance(Model<2, Linear<2>>&, Real);
template void advance(Model<2, Umls<2>>&, Real);
template void advance(Model<2, Projected<2>>&, Real);

}  // namespace talus
