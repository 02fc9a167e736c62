// The step of kernel projected in 3-D.
#include "kernels/projected.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

template class TransferOf<3, Projected<3>>;

}  // namespace talus
