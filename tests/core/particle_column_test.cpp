// Columns of particles: rows are what was set, bit by bit, and lie one after the other.
#include "core/particle_column.hpp"

#include <gtest/gtest.h>

#include <array>

namespace talus::column_test {
namespace {

constexpr std::size_t n_rows = 53, some_row = 16;

/// Nine numbers that no other row has.
Mat3 some(std::size_t row) { return 0.1 * Mat3{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}} + static_cast<Real>(row) * Mat3::Ones(); }

/// The column whose rows are some(row).
ParticleColumn<Mat3> filled()
{
  ParticleColumn<Mat3> F;
  F.resize(n_rows);
  for (std::size_t row = 0; row < n_rows; ++row)
    F.set(row, some(row));
  return F;
}

TEST(ParticleColumn, KeepsWhatIsSet)
{
  const ParticleColumn<Mat3> F = filled();
  ASSERT_EQ(F.size(), n_rows);
  const std::vector<Mat3> all = F.values();
  ASSERT_EQ(all.size(), n_rows);
  for (std::size_t row = 0; row < n_rows; ++row) {
    EXPECT_EQ(F[row], some(row)) << row;
    EXPECT_EQ(all[row], some(row)) << row;
  }
}

TEST(ParticleColumn, HoldsNumbersAsItHoldsTensors)
{
  ParticleColumn<Real> mass;
  EXPECT_TRUE(mass.empty());
  mass.assign(some_row, 0.1);
  mass.push_back(1e10);
  EXPECT_FALSE(mass.empty());
  ASSERT_EQ(mass.size(), some_row + 1);
  EXPECT_EQ(mass[some_row - 1], 0.1);
  EXPECT_EQ(mass[some_row], 1e10);
  mass.set(3, -2);
  EXPECT_EQ(mass[2], 0.1);
  EXPECT_EQ(mass[3], -2);
}

TEST(ParticleColumn, AssignReplacesAllRows)
{
  ParticleColumn<Mat3> F = filled();
  F.assign(2 * n_rows, some(7));
  ASSERT_EQ(F.size(), 2 * n_rows);
  for (std::size_t row = 0; row < F.size(); ++row)
    EXPECT_EQ(F[row], some(7)) << row;
}

TEST(ParticleColumn, RowsThatComeBackAreZero)
{
  for (const std::size_t left : {std::size_t{0}, std::size_t{3}, some_row, 2 * some_row + 1, n_rows - 1}) {
    ParticleColumn<Mat3> F = filled();
    F.resize(left);
    EXPECT_EQ(F.size(), left);
    F.resize(2 * n_rows);
    ASSERT_EQ(F.size(), 2 * n_rows);
    for (std::size_t row = 0; row < F.size(); ++row)
      EXPECT_EQ(F[row], row < left ? some(row) : Mat3(Mat3::Zero())) << row << " of " << left << " left";
  }
}

TEST(ParticleColumn, RowsLieOneAfterTheOtherWithRoomForAPackBehind)
{
  ParticleColumn<Vec3> v;
  v.assign(n_rows, Vec3(1, 2, 3));
  for (std::size_t row = 0; row < n_rows; ++row)
    EXPECT_EQ(v.row_at(row) - v.row_at(0), static_cast<std::ptrdiff_t>(3 * row));
  const Real* const last = v.row_at(n_rows - 1) + 2;
  for (int i = 1; i <= 3; ++i)
    EXPECT_EQ(last[i], 0);
}

/// A row of the column `from` saved and loaded, or copied, into another row of `to`; no other row of `to` changes.
template <class Column>
void expect_moved(const Column& from, Column to)
{
  const Column before = to;
  std::array<std::byte, row_bytes<Column>> bytes{};
  save_row(from, some_row - 1, bytes.data());
  load_row(bytes.data(), to, 2 * some_row);
  copy_row(from, 2, to, 1);
  for (std::size_t row = 0; row < to.size(); ++row)
    EXPECT_EQ(to[row], row == 2 * some_row ? from[some_row - 1] : row == 1 ? from[2] : before[row]) << row;
}

TEST(ParticleColumn, RowsAreCopiedSavedAndLoadedAsThoseOfAnArray)
{
  ParticleColumn<Mat3> other;
  other.assign(n_rows, some(1000));
  expect_moved(filled(), other);
  ParticleColumn<Real> mass, other_mass;
  other_mass.assign(n_rows, -1);
  std::vector<std::int64_t> id;
  for (std::size_t row = 0; row < n_rows; ++row) {
    mass.push_back(static_cast<Real>(row));
    id.push_back(static_cast<std::int64_t>(row));
  }
  expect_moved(mass, other_mass);
  expect_moved(id, std::vector<std::int64_t>(n_rows, -1));
}

TEST(ParticleColumn, SavesTheNumbersOfARowOneAfterTheOther)
{
  std::array<Real, 9> numbers{};
  save_row(filled(), some_row + 1, reinterpret_cast<std::byte*>(numbers.data()));
  const Mat3 row = some(some_row + 1);
  for (int c = 0; c < 9; ++c)
    EXPECT_EQ(numbers[static_cast<std::size_t>(c)], row(c));
}

TEST(ParticleColumn, BytesAreThoseOfItsRows)
{
  EXPECT_EQ(bytes_of(filled()), n_rows * 9 * 8);
  EXPECT_EQ(bytes_of(ParticleColumn<Real>()), 0u);
  EXPECT_EQ(bytes_of(std::vector<std::int32_t>(n_rows)), n_rows * 4);
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
