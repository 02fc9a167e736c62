// The step of kernel linear in 3-D.
#include "solver/transfer/compiled_transfers.hpp"

namespace talus {

template class TransferOf<3, Linear<3>>;

}  // namespace talus
