#pragma once
// The kernels whose transfers are compiled in a unit of their own, <kernel>_2d.cpp and <kernel>_3d.cpp.  Other kernels of the list are
// compiled with make_transfer.cpp.
#include "kernels/kernels.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

extern template class TransferOf<2, Linear<2>>;
extern template class TransferOf<3, Linear<3>>;
extern template class TransferOf<2, Umls<2>>;
extern template class TransferOf<3, Umls<3>>;
extern template class TransferOf<2, Projected<2>>;
extern template class TransferOf<3, Projected<3>>;

}  // namespace talus
