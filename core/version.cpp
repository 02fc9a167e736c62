// The only file that includes the generated header, so that a new commit recompiles nothing else.
#include "core/version.hpp"

#include <fmt/format.h>

#include "talus_version.hpp"

namespace talus {

Version version() noexcept { return {TALUS_VERSION, TALUS_COMMIT, TALUS_COMPILER, TALUS_BUILD_TYPE, TALUS_FLAGS}; }

std::string build_of(const Version& v) { return fmt::format("{}: {}", v.build_type, v.flags); }

std::string describe(const Version& v) { return fmt::format("talus {} ({}), {}, {}", v.number, v.commit, v.compiler, build_of(v)); }

}  // namespace talus
