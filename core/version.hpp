#pragma once
// Version, commit and compiler of this program: shown by `talus info`, stored in reports and checkpoints.

#include <string>
#include <string_view>

namespace talus {

struct Version {
  std::string_view number;
  std::string_view commit;  ///< "unknown" outside a git checkout, "-dirty" at the end if files differ from it
  std::string_view compiler, build_type, flags;
};

Version version() noexcept;
std::string build_of(const Version&);  ///< Release: -O3 ...
std::string describe(const Version&);  ///< one line: talus 0.1.0 (0123456789ab), GNU 12.2.0, Release: -O3 ...

}  // namespace talus
