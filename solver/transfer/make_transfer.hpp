#pragma once
// Construction of the transfer of the kernel that a scene names.
#include <memory>
#include <string_view>
#include <tuple>

#include "kernels/kernel.hpp"
#include "kernels/kernel_options.hpp"
#include "solver/model/transfer.hpp"

namespace talus {

/// The options of all kernels that have options.
using KernelOptions = std::tuple<UmlsOptions, ProjectedOptions>;

/// The transfer of the kernel with the name `kernel` in Kernels<D>.  Throws std::invalid_argument with cell and position if the kernel
/// refuses the mesh.
template <int D>
std::unique_ptr<Transfer<D>> make_transfer(std::string_view kernel, const KernelOptions& options, const Mesh<D>& mesh);

/// The transfer of a kernel; throws as above.  Defined in transfer_of.hpp, compiled for every kernel of the list.
template <class K, int D>
std::unique_ptr<Transfer<D>> make_transfer_of(const Mesh<D>& mesh, const Options<K>& options);

}  // namespace talus
