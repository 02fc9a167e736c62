#include "solver/transfer/make_transfer.hpp"

#include <type_traits>

#include "kernels/kernels.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus {

// Compiled in a unit of their own.
extern template class TransferOf<2, Linear<2>>;
extern template class TransferOf<3, Linear<3>>;
extern template class TransferOf<2, Umls<2>>;
extern template class TransferOf<3, Umls<3>>;
extern template class TransferOf<2, Projected<2>>;
extern template class TransferOf<3, Projected<3>>;

template <int D>
std::unique_ptr<Transfer<D>> make_transfer(std::string_view kernel, const KernelOptions& options, const Mesh<D>& mesh)
{
  std::unique_ptr<Transfer<D>> made;
  for_each_type(Kernels<D>{}, [&]<class K>() {
    if (K::name != kernel)
      return;
    if constexpr (std::is_same_v<Options<K>, NoOptions>)
      made = std::make_unique<TransferOf<D, K>>(mesh, NoOptions{});
    else
      made = std::make_unique<TransferOf<D, K>>(mesh, std::get<Options<K>>(options));
  });
  return made;
}

template std::unique_ptr<Transfer<2>> make_transfer(std::string_view, const KernelOptions&, const Mesh<2>&);
template std::unique_ptr<Transfer<3>> make_transfer(std::string_view, const KernelOptions&, const Mesh<3>&);

}  // namespace talus
