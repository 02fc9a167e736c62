// The law and the kernel of the tutorials (docs/tutorials/own_law, own_kernel) against the headers of this tree: the contracts that every law and
// kernel keeps, run over them alone, and the tests that the tutorials show.
#include <gtest/gtest.h>

#include "docs/tutorials/own_kernel/cell_mean.hpp"
#include "docs/tutorials/own_law/maxwell.hpp"
#include "docs/tutorials/own_law/sample.hpp"
#include "kernels/kernels.hpp"

// The contracts are typed over lists; the names here are found before those of `talus`.
namespace talus::law_contract_test {

using Laws = TypeList<Maxwell>;
using AnyBatch = std::variant<Batch<Maxwell>>;

template <class Any, class F>
requires std::is_same_v<std::remove_const_t<Any>, AnyBatch>
void for_each_history(Any& batch, F&& f) { talus::for_each_history(std::get<0>(batch), f); }
inline bool prestress(AnyBatch& batch, Index i, const Mat3& stress) noexcept { return talus::prestress(std::get<0>(batch), i, stress); }
inline void permute(AnyBatch& batch, std::span<const Index> order)
{
  auto& history = std::get<0>(batch).history;
  const auto former = history;
  for (std::size_t i = 0; i < order.size(); ++i)
    history[i] = former[static_cast<std::size_t>(order[i])];
}

}  // namespace talus::law_contract_test
namespace talus::test::kernel_contract_test {

template <int D>
using Kernels = TypeList<CellMean<D>>;

}  // namespace talus::test::kernel_contract_test

#include "docs/tutorials/own_kernel/cell_mean_test.cpp"
#include "docs/tutorials/own_law/maxwell_test.cpp"
#include "tests/kernels/kernel_contract_test.cpp"
#include "tests/materials/law_contract_test.cpp"
