// The step of kernel linear in 2-D.
#include "solver/transfer/compiled_transfers.hpp"

namespace talus {

template class TransferOf<2, Linear<2>>;

}  // namespace talus
