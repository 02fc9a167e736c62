#include "solver/transfer/make_transfer.hpp"

#include <type_traits>

#include "kernels/kernels.hpp"

namespace talus {

template <int D>
std::unique_ptr<Transfer<D>> make_transfer(std::string_view kernel, const KernelOptions& options, const Mesh<D>& mesh)
{
  std::unique_ptr<Transfer<D>> made;
  for_each_type(Kernels<D>{}, [&]<class K>() {
    if (K::name != kernel)
      return;
    if constexpr (std::is_same_v<Options<K>, NoOptions>)
      made = make_transfer_of<K>(mesh, NoOptions{});
    else
      made = make_transfer_of<K>(mesh, std::get<Options<K>>(options));
  });
  return made;
}

template std::unique_ptr<Transfer<2>> make_transfer(std::string_view, const KernelOptions&, const Mesh<2>&);
template std::unique_ptr<Transfer<3>> make_transfer(std::string_view, const KernelOptions&, const Mesh<3>&);

}  // namespace talus
