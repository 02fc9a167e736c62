#pragma once
// Numbers as a page of a run carries them: in few bits, packed by zlib, as base64.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// One array as it stands in the page.
struct PageBlock {
  std::string_view type;  ///< u8, u16, u32, f32
  std::int64_t count = 0;
  bool delta = false;   ///< differences of neighbours, modulo 2^bits
  bool planes = false;  ///< all lowest bytes first, then all second ones, ...
  std::string base64;   ///< of the zlib stream
};

PageBlock packed(std::span<const std::uint8_t> values);
/// With differences where that takes less.
PageBlock packed(std::span<const std::uint16_t> values);
/// As differences.
PageBlock packed(std::span<const std::uint32_t> values);
PageBlock packed(std::span<const float> values);

/// Number of a value in [low, high]: 0 to 65534; 65535 for what is no finite number.  Back again it is off by at most half of
/// (high - low) / 65534.
std::vector<std::uint16_t> quantised(std::span<const Real> values, Real low, Real high);

}  // namespace talus
