// How fields of vectors and tensors are shown by one number.
#include "core/field_component.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"

namespace talus::viewed_test {

namespace {

TEST(ViewedField, NamesComponentsAndLabels)
{
  EXPECT_EQ(ViewedField::of("stress").component_of(6), std::nullopt);
  EXPECT_EQ(ViewedField::of("stress:xy").component_of(6), 3);
  EXPECT_EQ(ViewedField::of("velocity_gradient:zx").component_of(9), 6);
  EXPECT_EQ(ViewedField::of("stress").label(6), "stress (von Mises)");
  EXPECT_EQ(ViewedField::of("velocity:y").label(3), "velocity y");
  EXPECT_EQ(ViewedField::of("plastic_strain").label(1), "plastic strain");
  EXPECT_THROW(ViewedField::of("velocity:xy").component_of(3), Error);
  EXPECT_THROW(ViewedField::of("plastic_strain:x").component_of(1), Error);
}

TEST(ViewedField, AVectorIsItsLengthASymmetricTensorItsVonMisesValue)
{
  EXPECT_EQ(viewed_value(std::vector<Real>{-2}), -2);
  EXPECT_EQ(viewed_value(std::vector<Real>{3, 0, -4}), 5);
  EXPECT_DOUBLE_EQ(viewed_value(std::vector<Real>{7, 0, 0, 0, 0, 0}), 7) << "uniaxial";
  EXPECT_DOUBLE_EQ(viewed_value(std::vector<Real>{1, 1, 1, 0, 2, 0}), 2 * std::sqrt(3.0)) << "pressure does not count";
}

}  // namespace

}  // namespace talus::viewed_test
