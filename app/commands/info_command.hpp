#pragma once
// Command talus info.

namespace talus {

void print_info();

}  // namespace talus
