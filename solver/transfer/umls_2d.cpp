// The step of kernel umls in 2-D.
#include "kernels/umls.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

template class TransferOf<2, Umls<2>>;

}  // namespace talus
