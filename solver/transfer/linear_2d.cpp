// The step of kernel linear in 2-D.
#include "kernels/linear.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

template class TransferOf<2, Linear<2>>;

}  // namespace talus
