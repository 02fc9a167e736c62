// The step of kernel projected in 2-D.
#include "solver/transfer/compiled_transfers.hpp"

namespace talus {

template class TransferOf<2, Projected<2>>;

}  // namespace talus
