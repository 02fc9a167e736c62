// The step of kernel projected in 3-D.
#include "solver/transfer/compiled_transfers.hpp"

namespace talus {

template class TransferOf<3, Projected<3>>;

}  // namespace talus
