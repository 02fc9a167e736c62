// talus info, talus manual
#include "app/commands/info_command.hpp"

#include <fmt/format.h>

#include "core/parallel/threads.hpp"
#include "core/version.hpp"
#include "io/scene/manual/manual.hpp"
#include "kernels/kernels.hpp"
#include "materials/interface/any_law.hpp"

namespace talus {

void print_info()
{
  fmt::print("{}\n", describe(version()));
  fmt::print("threads: {}\n", threads());
  fmt::print("laws:\n");
  for (const LawDescription* law : known_laws())
    fmt::print("  {:<20} {}\n", law->name, law->summary);
  fmt::print("kernels:\n");
  for_each_type(Kernels<2>{}, []<class K>() { fmt::print("  {:<20} {}\n", K::name, K::summary); });
  fmt::print(
      "licence: the source is under the Apache License 2.0.  This program is linked with gmsh, which is under the GNU General Public\n"
      "License (version 2 or later), so whoever passes on the compiled program does so under the GPL, version 3.  See THIRD_PARTY.md.\n");
}

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
