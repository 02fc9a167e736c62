#pragma once
// The step is compiled once for every kernel of the list, in instances_2d.cpp and instances_3d.cpp: whoever runs models need not.
// A kernel that is missing here works all the same; it is compiled wherever it is used.
#include "kernels/kernels.hpp"
#include "solver/advance.hpp"

namespace talus {

extern template void advance(Model<2, Linear<2>>&, Real);
extern template void advance(Model<2, Umls<2>>&, Real);
extern template void advance(Model<2, Projected<2>>&, Real);
extern template void advance(Model<3, Linear<3>>&, Real);
extern template void advance(Model<3, Umls<3>>&, Real);
extern template void advance(Model<3, Projected<3>>&, Real);

}  // namespace talus
