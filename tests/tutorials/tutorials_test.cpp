// The law and the kernel of the tutorials (docs/tutorials/own_law, own_kernel) against the headers of this tree: the contracts that every law and
// kernel keeps, run over them alone, and the tests that the tutorials show.
#include <gtest/gtest.h>

#include "docs/tutorials/own_kernel/cell_mean.hpp"
#include "docs/tutorials/own_law/maxwell.hpp"
#include "kernels/kernels.hpp"
#include "materials/interface/constitutive_law_of.hpp"

// Below the law, as in materials/law_examples.hpp.
#include "docs/tutorials/own_law/example.hpp"

// The contracts are typed over lists; the names here are found before those of `talus`.
namespace talus::law_contract_test {

using Laws = TypeList<Maxwell>;

}  // namespace talus::law_contract_test
namespace talus::test::kernel_contract_test {

template <int D>
using Kernels = TypeList<CellMean<D>>;

}  // namespace talus::test::kernel_contract_test

#include "docs/tutorials/own_kernel/cell_mean_test.cpp"
#include "docs/tutorials/own_law/maxwell_test.cpp"
#include "tests/kernels/kernel_contract_test.cpp"
#include "tests/materials/law_contract_test.cpp"
