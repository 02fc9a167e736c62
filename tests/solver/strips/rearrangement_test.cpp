// Particles of a strip that leave and come, against a list that is put together particle by particle.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "solver/strips/rearrangement.hpp"

namespace talus::testing::rearrangement_test {
namespace {

constexpr std::size_t arrays = 5, room = 128, width = 9;  // a record has numbers that no array holds
constexpr Index first_number = 2;                         // of the first array, in a record

/// Number k of particle `id`; every number of every particle is another one.
Real number_of(Index id, std::size_t k) { return 100.0 * id + static_cast<Real>(k) + 0.25; }

/// n particles, of which each leaves with this probability; so many others come to places drawn at random.
struct Change {
  Index n;
  Real leaves;
  Index come;
};

void expect_like_a_list(const Change& change, std::mt19937& random, Rearrangement& rearrangement)
{
  std::vector<Real> numbers(arrays * room, -1.0);
  for (std::size_t k = 0; k < arrays; ++k)
    for (Index i = 0; i < change.n; ++i)
      numbers[k * room + static_cast<std::size_t>(i)] = number_of(i, k);

  std::vector<Index> leaving;
  std::bernoulli_distribution leaves(change.leaves);
  for (Index i = 0; i < change.n; ++i)
    if (leaves(random))
      leaving.push_back(i);
  std::vector<Index> before(static_cast<std::size_t>(change.come));
  std::uniform_int_distribution<Index> any(0, change.n);
  std::generate(before.begin(), before.end(), [&] { return any(random); });
  std::sort(before.begin(), before.end());
  std::vector<std::vector<Real>> records;
  std::vector<Insertion> coming;
  for (std::size_t j = 0; j < before.size(); ++j) {
    std::vector<Real>& record = records.emplace_back(width, -2.0);
    for (std::size_t k = 0; k < arrays; ++k)
      record[static_cast<std::size_t>(first_number) + k] = number_of(1000 + static_cast<Index>(j), k);
    coming.push_back({before[j], record.data()});
  }

  std::vector<Index> ids;  // in the new order
  auto next = coming.begin();
  for (Index i = 0; i <= change.n; ++i) {
    for (; next != coming.end() && next->before == i; ++next)
      ids.push_back(1000 + static_cast<Index>(next - coming.begin()));
    if (i < change.n && !std::binary_search(leaving.begin(), leaving.end(), i))
      ids.push_back(i);
  }

  rearrangement.plan(change.n, leaving, coming);
  ASSERT_EQ(rearrangement.size(), static_cast<Index>(ids.size()));
  // In two parts, as a strip does.
  rearrangement.move(numbers.data(), room, 2, first_number);
  rearrangement.move(numbers.data() + 2 * room, room, static_cast<Index>(arrays) - 2, first_number + 2);
  for (std::size_t k = 0; k < arrays; ++k)
    for (std::size_t i = 0; i < ids.size(); ++i)
      ASSERT_EQ(numbers[k * room + i], number_of(ids[i], k)) << change.n << " particles, array " << k << ", place " << i;
}

TEST(Rearrangement, GivesEveryParticleItsPlace)
{
  std::mt19937 random(7);
  Rearrangement rearrangement;
  for (int round = 0; round < 200; ++round)
    for (const Index n : {0, 1, 3, 4, 5, 8, 17, 64, 71})
      for (const Real leaves : {0.0, 0.02, 0.3, 1.0})
        for (const Index come : {0, 1, 2, 7, 40})
          expect_like_a_list({n, leaves, come}, random, rearrangement);
}

TEST(Rearrangement, DoesNotTouchWhatStandsInFrontOfTheFirstChange)
{
  std::vector<Real> numbers(16);
  std::iota(numbers.begin(), numbers.end(), 0.0);
  const std::vector<Index> leaving{6};
  Rearrangement rearrangement;
  rearrangement.plan(9, leaving, {});
  rearrangement.move(numbers.data(), 16, 1, 0);
  EXPECT_EQ(rearrangement.size(), 8);
  EXPECT_EQ(std::vector<Real>(numbers.begin(), numbers.begin() + 8), (std::vector<Real>{0, 1, 2, 3, 4, 5, 7, 8}));
}

}  // namespace
}  // namespace talus::testing::rearrangement_test
