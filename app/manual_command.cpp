// talus manual
#include <fmt/format.h>

#include "app/commands.hpp"
#include "io/manual.hpp"

namespace talus {

void print_manual(bool schema) { fmt::print("{}", schema ? scene_schema() : scene_manual()); }

}  // namespace talus
