#pragma once
// The transfer of the kernel that a scene names.
#include <memory>
#include <string_view>
#include <tuple>

#include "kernels/projected_options.hpp"
#include "kernels/umls_options.hpp"
#include "solver/model/transfer.hpp"

namespace talus {

/// Options of every kernel that has some.
using KernelOptions = std::tuple<UmlsOptions, ProjectedOptions>;

/// `kernel` is a name of the list Kernels<D>.  std::invalid_argument: the kernel refuses the mesh, naming cell and place.
template <int D>
std::unique_ptr<Transfer<D>> make_transfer(std::string_view kernel, const KernelOptions& options, const Mesh<D>& mesh);

}  // namespace talus
