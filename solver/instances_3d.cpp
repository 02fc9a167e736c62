// The step of every kernel in 3-D, compiled once.
#include "solver/instances.hpp"

namespace talus {

template void advance(Model<3, Linear<3>>&, Real);
template void advance(Model<3, Umls<3>>&, Real);
template void advance(Model<3, Projected<3>>&, Real);

}  // namespace talus
