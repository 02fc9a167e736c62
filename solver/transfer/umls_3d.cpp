// The step of kernel umls in 3-D.
#include "solver/transfer/compiled_transfers.hpp"

namespace talus {

template class TransferOf<3, Umls<3>>;

}  // namespace talus
