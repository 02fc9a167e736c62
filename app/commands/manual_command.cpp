// talus manual
#include <fmt/format.h>

#include "app/commands/manual_command.hpp"
#include "io/scene/manual/manual.hpp"

namespace talus {

void print_manual(bool schema, const std::vector<std::string>& words)
{
  if (words.empty())
    return fmt::print("{}", schema ? scene_schema() : scene_manual());
  std::string text;
  for (const std::string& word : words)
    text.append(text.empty() ? "" : "\n").append(manual_of(word));
  fmt::print("{}", text);
}

}  // namespace talus
