#pragma once
// The list of kernels that a scene can name.  Loops over it turn a name into a type (core/type_list.hpp).
#include "core/type_list.hpp"
#include "kernels/linear.hpp"
#include "kernels/projected.hpp"
#include "kernels/umls.hpp"

namespace talus {

/// The kernels on meshes of dimension D, one per line.
template <int D>
using Kernels = TypeList<Linear<D>,      // linear shape functions
                         Umls<D>,        // moving least squares
                         Projected<D>>;  // linear shape functions with operators at the nodes

}  // namespace talus
