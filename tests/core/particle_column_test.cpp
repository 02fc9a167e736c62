// Columns of particles: rows are what was set, in double exactly, in single to its rounding.
#include "core/particle_column.hpp"

#include <gtest/gtest.h>

namespace talus::column_test {
namespace {

const Mat3 strained = Mat3::Identity() + 1e-6 * Mat3{{1, 2, 3}, {0, -1, 4}, {0.5, 0, 0.1}};

TEST(ParticleColumn, KeepsRowsExactlyInDouble)
{
  ParticleColumn<Mat3, Rest::identity> F;
  F.assign(3, Mat3::Identity());
  F.set(1, strained);
  F.push_back(2 * strained);
  ASSERT_EQ(F.size(), 4u);
  EXPECT_EQ(F[0], Mat3::Identity());
  EXPECT_EQ(F[1], strained);
  EXPECT_EQ(F[3], 2 * strained);
  EXPECT_EQ(F.precision(), Precision::full);
}

TEST(ParticleColumn, RoundsRowsInSingleAndTakesHalfTheRoom)
{
  ParticleColumn<Real> mass;
  mass.assign(2, 0.1);
  const auto bytes = [](const auto& rows) { return rows.size() * sizeof(rows[0]); };
  EXPECT_EQ(mass.visit(bytes), 16u);
  mass.keep_in(Precision::single);
  EXPECT_EQ(mass.visit(bytes), 8u);
  EXPECT_EQ(mass[1], static_cast<double>(0.1F));
  mass.push_back(1e10);
  EXPECT_EQ(mass[2], 1e10);
  mass.keep_in(Precision::full);
  EXPECT_EQ(mass.visit(bytes), 24u);
  EXPECT_EQ(mass[0], static_cast<double>(0.1F));
}

TEST(ParticleColumn, KeepsSmallStrainsInSingle)
{
  ParticleColumn<Mat3, Rest::identity> F;
  F.assign(1, strained);
  F.keep_in(Precision::single);
  const Mat3 strain = strained - Mat3::Identity();
  EXPECT_LT((F[0] - strained).norm(), 1e-7 * strain.norm()) << "F itself in single would lose a tenth of the strain";
  F.set(0, Mat3(strained * strained));
  EXPECT_LT((F[0] - strained * strained).norm(), 1e-7 * strain.norm());
}

TEST(ParticleColumn, StaysInItsPrecisionWhenItIsEmpty)
{
  ParticleColumn<Vec<2>> applied;
  applied.keep_in(Precision::single);
  applied.assign(5, {1, 2});
  EXPECT_EQ(applied.precision(), Precision::single);
  EXPECT_EQ(applied[4], Vec<2>(1, 2));
}

TEST(Rows, LieInWholeLargePagesWhereTheyFillSome)
{
  Rows<Real> rows;
  for (int i = 0; i < 3'000'000; ++i)
    rows.push_back(i);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(rows.data()) % LargePages<Real>::page, 0u);
  EXPECT_EQ(rows[0], 0);
  EXPECT_EQ(rows[2'999'999], 2'999'999);
  rows.resize(3);
  rows.shrink_to_fit();
  EXPECT_EQ(rows[2], 2);
}

}  // namespace
}  // namespace talus::column_test
