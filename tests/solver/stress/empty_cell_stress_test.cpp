// Stress of cells without particles: by numbers of the whole mesh, where cells leave the list, and lists that a file may not have.
#include "solver/stress/empty_cell_stress.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace talus::empty_cell_stress_test {
namespace {

EmptyCellStress<2> of_cells(std::initializer_list<std::int64_t> cells)
{
  EmptyCellStress<2> all;
  for (const std::int64_t c : cells)
    all.add(c, Mat<2>::Constant(static_cast<Real>(c)));
  return all;
}

std::vector<Index> cells_of(const EmptyCellStress<2>& all, const Subdomain& subdomain)
{
  std::vector<Index> cells;
  all.for_each(subdomain, [&](Index c, const Mat<2>&) { cells.push_back(c); });
  return cells;
}

/// The second block of a mesh of two.
Subdomain second_block()
{
  Subdomain part;
  part.block = {1}, part.rank_of_block = {0}, part.rank_of_whole_block = {1, 0};
  part.whole_cells = 2 * block_cells;
  return part;
}

TEST(EmptyCellStress, KeepsTheCellsThatItIsTold)
{
  EmptyCellStress<2> all = of_cells({2, 5, 7});
  all.keep_if({}, [](Index c) { return c != 5; });
  EXPECT_EQ(cells_of(all, {}), (std::vector<Index>{2, 7}));
  all.for_each({}, [](Index c, const Mat<2>& stress) { EXPECT_EQ(stress, Mat<2>::Constant(c)); });
}

TEST(EmptyCellStress, APartHasItsCellsByItsOwnNumbers)
{
  EmptyCellStress<2> all = of_cells({3, block_cells + 1, block_cells + 4});
  EXPECT_EQ(cells_of(all, second_block()), (std::vector<Index>{1, 4}));
  all.keep_if(second_block(), [](Index c) { return c == 4; });
  EXPECT_EQ(cells_of(all, {}), (std::vector<Index>{3, block_cells + 4})) << "cells of other parts stay";
}

TEST(EmptyCellStress, RefusesCellsThatTheMeshDoesNotHave)
{
  EXPECT_TRUE(EmptyCellStress<2>().fits(0));
  EXPECT_TRUE(of_cells({0, 7}).fits(8));
  EXPECT_FALSE(of_cells({0, 8}).fits(8));
  EXPECT_FALSE(of_cells({-1, 7}).fits(8));
  EXPECT_FALSE(of_cells({4, 3}).fits(8));
  EXPECT_FALSE(of_cells({3, 3}).fits(8));
  EmptyCellStress<2> broken;
  broken.add(3, Mat<2>::Constant(std::numeric_limits<Real>::quiet_NaN()));
  EXPECT_FALSE(broken.fits(8));
}

}  // namespace
}  // namespace talus::empty_cell_stress_test
