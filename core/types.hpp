#pragma once
// Numbers, small vectors and small tensors, used in every folder.
#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace talus {

using Real = double;
using Index = std::int32_t;  ///< number of a node, cell or particle on this rank; ids that survive sorting are std::int64_t

/// The value that means "no cell, facet or node" in lists; interfaces use std::optional instead.
inline constexpr Index none = -1;

template <int D>
using Vec = Eigen::Matrix<Real, D, 1, Eigen::DontAlign>;
template <int D>
using Mat = Eigen::Matrix<Real, D, D, Eigen::DontAlign>;
/// Small tensors.  T is Real, or SimdReal for the tensors of several particles at once.
template <class T>
using Mat3Of = Eigen::Matrix<T, 3, 3, Eigen::DontAlign>;
/// The six entries xx, yy, zz, xy, yz, xz of a symmetric 3x3 tensor.
template <class T>
using Sym3Of = Eigen::Matrix<T, 6, 1, Eigen::DontAlign>;
using Vec3 = Vec<3>;
using Mat3 = Mat3Of<Real>;
using Sym3 = Sym3Of<Real>;

/// Lists in compressed rows: row i holds item[begin[i]] .. item[begin[i+1]-1].
struct Csr {
  std::vector<Index> begin{0};
  std::vector<Index> item;
  Index size() const noexcept { return static_cast<Index>(begin.size()) - 1; }
  std::span<const Index> operator[](Index i) const noexcept
  {
    const auto first = static_cast<std::size_t>(begin[static_cast<std::size_t>(i)]);
    const auto last = static_cast<std::size_t>(begin[static_cast<std::size_t>(i) + 1]);
    return {item.data() + first, last - first};
  }
};

}  // namespace talus
