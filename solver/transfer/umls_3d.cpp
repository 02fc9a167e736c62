// The step of kernel umls in 3-D.
#include "kernels/umls.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

template class TransferOf<3, Umls<3>>;

}  // namespace talus
