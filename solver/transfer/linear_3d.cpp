// The step of kernel linear in 3-D.
#include "kernels/linear.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

template class TransferOf<3, Linear<3>>;

}  // namespace talus
