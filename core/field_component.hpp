#pragma once
// Vectors and tensors shown as one number per item, with the name of that number, for pictures, pages and tables.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Names of the components: x, y, z of a vector; xx, yy, zz, xy, yz, xz of a symmetric tensor; xx, xy, ... by rows of any other tensor; no
/// names for other numbers of components.
std::vector<std::string> component_names(int components);

/// The number shown for an entry: a scalar itself, the von Mises value of a symmetric tensor, the length of anything else.
Real viewed_value(std::span<const Real> entry) noexcept;

/// A field as the user names it: "velocity", "velocity:x" or "stress:xy".
struct ViewedField {
  std::string name;
  std::string component = {};  ///< empty: all of them, by viewed_value()

  static ViewedField of(std::string_view text);
  /// Index of the component in a field with `components` components; nothing if no component is named.  Throws Error if the field has no
  /// such component.
  std::optional<int> component_of(int components) const;
  /// The name to print, such as "stress (von Mises)", "velocity x" or "plastic strain".
  std::string label(int components) const;
};

}  // namespace talus
