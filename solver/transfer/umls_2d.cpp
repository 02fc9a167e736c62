// The step of kernel umls in 2-D.
#include "solver/transfer/compiled_transfers.hpp"

namespace talus {

template class TransferOf<2, Umls<2>>;

}  // namespace talus
