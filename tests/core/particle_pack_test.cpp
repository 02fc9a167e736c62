// Packs of rows of every kind of column, in any order, of fewer than four, and at the end of the column.
#include "core/particle_pack.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

constexpr std::size_t n_rows = 40;

template <class Value>
class Packs : public ::testing::Test {
 protected:
  static constexpr int components = ParticleColumn<Value>::components;
  Packs()
  {
    column.resize(n_rows);
    for (std::size_t row = 0; row < n_rows; ++row)
      for (int c = 0; c < components; ++c)
        column.row_at(row)[c] = static_cast<Real>(row) + 0.01 * c;
  }
  static Real number(const Value& value, int c)
  {
    if constexpr (components == 1)
      return value;
    else
      return value(c);
  }
  static Real lane(const With<SimdReal, Value>& value, int c, int lane)
  {
    if constexpr (components == 1)
      return value[lane];
    else
      return value(c)[lane];
  }
  /// Loads a pack of these rows, and stores it to a column of the same length.
  void check(const std::vector<Index>& rows) const
  {
    const ParticlePack pack(rows, 0);
    const auto all = pack.load(column);
    for (int i = 0; i < pack_size; ++i) {
      const Index row = rows[std::min(static_cast<std::size_t>(i), rows.size() - 1)];
      for (int c = 0; c < components; ++c)
        EXPECT_EQ(lane(all, c, i), number(column[static_cast<std::size_t>(row)], c));
    }
    ParticleColumn<Value> to;
    to.resize(n_rows);
    pack.store(all, to);
    for (std::size_t row = 0; row < n_rows; ++row) {
      const bool is_in = std::find(rows.begin(), rows.begin() + pack.count, static_cast<Index>(row)) != rows.begin() + pack.count;
      for (int c = 0; c < components; ++c)
        EXPECT_EQ(number(to[row], c), is_in ? number(column[row], c) : 0) << "row " << row << ", number " << c;
    }
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(to.row_at(n_rows)[i], 0) << "written behind the last row";
  }
  ParticleColumn<Value> column;
};
using Values = ::testing::Types<Real, Vec<2>, Vec3, Mat<2>, Sym3, Mat3>;
TYPED_TEST_SUITE(Packs, Values);

TYPED_TEST(Packs, LoadAndStoreNeighbours)
{
  this->check({0, 1, 2, 3});
  this->check({36, 37, 38, 39});
}

TYPED_TEST(Packs, LoadAndStoreRowsInAnyOrder)
{
  this->check({5, 2, 9, 8});
  this->check({39, 6, 5, 7});
  this->check({0, 1, 20, 39});
}

TYPED_TEST(Packs, LoadAndStoreFewerThanFour)
{
  this->check({39});
  this->check({38, 39});
  this->check({38, 39, 37});
  this->check({9, 8, 10});
}

}  // namespace
}  // namespace talus
