#pragma once
// How a field of vectors or tensors is shown by one number an item, and what that number is called: the same in pictures, pages and tables.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// x, y, z of a vector; xx, yy, zz, xy, yz, xz of a symmetric tensor; xx, xy, ... by rows of any tensor; none of anything else.
std::vector<std::string> component_names(int components);

/// A scalar as it is, a symmetric tensor by its von Mises value, anything else by its length.
Real viewed_value(std::span<const Real> entry) noexcept;

/// A field as a user asks for it: "velocity", "velocity:x", "stress:xy".
struct ViewedField {
  std::string name;
  std::string component = {};  ///< empty: all of them, by viewed_value()

  static ViewedField of(std::string_view text);
  /// Number of the component in a field of so many; nothing where none was asked for.  Error: it has no such one.
  std::optional<int> component_of(int components) const;
  /// "stress (von Mises)", "velocity x", "plastic strain".
  std::string label(int components) const;
};

}  // namespace talus
