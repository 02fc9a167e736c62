#pragma once
// Command talus manual.
#include <string>
#include <vector>

namespace talus {

/// Every key of a scene: Markdown, or JSON Schema; or what these words mean.  Error: nothing.
void print_manual(bool schema, const std::vector<std::string>& words);

}  // namespace talus
