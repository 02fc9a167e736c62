#include "io/scene/wall_names.hpp"

#include <fmt/format.h>

#include <map>
#include <variant>

namespace talus {

std::vector<std::string> wall_names(const std::vector<BoundarySpec>& boundaries)
{
  std::vector<std::string> names;
  std::map<std::string, int> times;
  for (const BoundarySpec& boundary : boundaries) {
    const std::string& group = std::visit([](const auto& spec) -> const std::string& { return spec.on; }, boundary);
    const int count = ++times[group];
    names.push_back(count == 1 ? group : fmt::format("{}_{}", group, count));
  }
  return names;
}

}  // namespace talus
