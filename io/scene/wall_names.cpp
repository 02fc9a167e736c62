#include "io/scene/wall_names.hpp"

#include <fmt/format.h>

#include <map>

namespace talus {

std::vector<std::string> wall_names(const std::vector<BoundaryOptions>& boundaries)
{
  std::vector<std::string> names;
  std::map<std::string, int> times;
  for (const BoundaryOptions& boundary : boundaries) {
    const std::string& group = common_of(boundary).on;
    const int count = ++times[group];
    names.push_back(count == 1 ? group : fmt::format("{}_{}", group, count));
  }
  return names;
}

}  // namespace talus
