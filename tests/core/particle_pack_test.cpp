// Packs of rows, whether or not they are neighbours, and packs of fewer than four.
#include "core/particle_pack.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace talus {
namespace {

class Packs : public ::testing::Test {
 protected:
  Packs()
  {
    for (int row = 0; row < 40; ++row)
      column.push_back({row + 0.25, -row});
  }
  /// Loads a pack of these rows, and stores it to a column of the same length.
  void check(const std::vector<Index>& rows) const
  {
    const ParticlePack pack(rows, 0);
    const auto all = pack.load(column);
    for (std::size_t lane = 0; lane < pack_size; ++lane)
      for (int c = 0; c < 2; ++c)
        EXPECT_EQ(all[c][static_cast<int>(lane)], column[static_cast<std::size_t>(rows[std::min(lane, rows.size() - 1)])][c]);
    ParticleColumn<Vec<2>> to;
    to.assign(column.size(), Vec<2>::Zero());
    pack.store(all, to);
    for (std::size_t row = 0; row < to.size(); ++row) {
      const bool is_in = std::find(rows.begin(), rows.begin() + pack.count, static_cast<Index>(row)) != rows.begin() + pack.count;
      EXPECT_EQ(to[row], is_in ? column[row] : Vec<2>(Vec<2>::Zero())) << row;
    }
  }
  ParticleColumn<Vec<2>> column;
};

TEST_F(Packs, LoadAndStoreNeighbours)
{
  for (const Index first : {0, 3, 12, 13, 14, 15, 16, 36})
    check({first, first + 1, first + 2, first + 3});
}

TEST_F(Packs, LoadAndStoreRowsInAnyOrder)
{
  check({5, 2, 9, 8});  // the last one is where it would be among neighbours
  check({4, 6, 5, 7});
  check({7, 6, 5, 4});
  check({0, 1, 20, 3});
}

TEST_F(Packs, LoadAndStoreFewerThanFour)
{
  for (const Index first : {0, 12, 14, 37})
    for (Index n = 1; n <= 3; ++n) {
      std::vector<Index> rows(static_cast<std::size_t>(n));
      std::iota(rows.begin(), rows.end(), first);
      check(rows);
    }
  check({9, 8, 10});
}

}  // namespace
}  // namespace talus
