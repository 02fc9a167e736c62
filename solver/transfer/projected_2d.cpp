// The step of kernel projected in 2-D.
#include "kernels/projected.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

template class TransferOf<2, Projected<2>>;

}  // namespace talus
