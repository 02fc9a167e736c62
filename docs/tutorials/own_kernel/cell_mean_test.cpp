#include <gtest/gtest.h>

#include "tests/kernels/probe.hpp"

namespace talus::test::cell_mean_test {

TEST(CellMean, GivesEveryVertexAThirdOfTheMass)
{
  const Mesh<2>& mesh = jittered_mesh<2>();
  const CellMean<2> kernel(mesh);
  Probe<CellMean<2>, 2> probe(kernel, mesh);
  probe.enter(0);
  probe.evaluate(mesh.node(mesh.cell(0)[1]));
  for (int a = 0; a < 3; ++a)
    EXPECT_EQ(probe.weights.w[a], 1.0 / 3);
}

}  // namespace talus::test::cell_mean_test
