// Field lists are walked in order of declaration with the right kind for each member.
#include "core/fields.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/type_list.hpp"

namespace talus::fields_test {
namespace {

struct Inner {
  Real x = 4;
  static constexpr auto fields() { return std::tuple(optional("x", &Inner::x, any, "m", "a length")); }
};
struct Sample {
  Real mass = 0;
  int count = 3;
  Inner inner;
  std::vector<Inner> items;
  static constexpr auto fields()
  {
    return std::tuple(required("mass", &Sample::mass, positive, "kg", "mass"),
                      optional("count", &Sample::count, at_least(1), "-", "how many"), group("inner", &Sample::inner, "a nested block"),
                      optional_list("items", &Sample::items, "a list"));
  }
};

TEST(Fields, AreVisitedInOrderAndReachTheirMembers)
{
  Sample sample;
  std::vector<std::string> keys;
  for_each_field<Sample>([&](const auto& field) {
    keys.emplace_back(field.key);
    auto& value = sample.*field.member;
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Real>)
      value = 7.5;
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>)
      value += 1;
  });
  EXPECT_THAT(keys, ::testing::ElementsAre("mass", "count", "inner", "items"));
  EXPECT_EQ(sample.mass, 7.5);
  EXPECT_EQ(sample.count, 4);
}

TEST(Fields, KnowWhetherTheyAreNeeded)
{
  EXPECT_EQ(std::get<0>(Sample::fields()).need, Need::required);
  EXPECT_EQ(std::get<1>(Sample::fields()).need, Need::optional);
  EXPECT_EQ(std::get<3>(Sample::fields()).need, Need::optional);
  EXPECT_TRUE(std::get<1>(Sample::fields()).range.holds(1));
}

TEST(TypeList, IsFoldedInOrder)
{
  std::string sizes;
  for_each_type(TypeList<char, std::int32_t, Real>{}, [&]<class T>() { sizes += std::to_string(sizeof(T)); });
  EXPECT_EQ(sizes, "148");
}

}  // namespace
}  // namespace talus::fields_test
