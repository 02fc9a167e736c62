#pragma once
// Keys that every boundary condition of a scene has.
#include <algorithm>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// The options of a condition derive from this and list its keys among their own.
struct BoundaryCommon {
  std::string on;                   ///< group of the mesh
  std::vector<std::string> during;  ///< names of the stages in which it acts; empty: all
  SourceLocation where;

  bool acts_in(const std::string& stage) const { return during.empty() || std::find(during.begin(), during.end(), stage) != during.end(); }

 protected:
  static constexpr auto on_key(std::string_view meaning) { return required("on", &BoundaryCommon::on, any, "-", meaning); }
  static constexpr auto during_key()
  {
    return optional("during", &BoundaryCommon::during, any, "-", "names of the stages in which it acts; default all");
  }
};

}  // namespace talus
