#pragma once
// Numbers of the report: quantised, compressed by zlib, in base64.
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// One array as it is stored in the page.
struct PageBlock {
  std::string_view type;  ///< u8, u16, u32, f32
  std::int64_t count = 0;
  bool delta = false;   ///< differences of neighbours, modulo 2^bits
  bool planes = false;  ///< all lowest bytes first, then all second bytes, ...
  std::string base64;   ///< text of the zlib stream
};

PageBlock packed(std::span<const std::uint8_t> values);
/// Compresses values, as differences if that takes fewer bytes.
PageBlock packed(std::span<const std::uint16_t> values);
/// Compresses values as differences.
PageBlock packed(std::span<const std::uint32_t> values);
PageBlock packed(std::span<const float> values);

/// Quantises values in [low, high] to 0 ... 65534; 65535 stands for values that are not finite.  The error is at most half of (high - low)
/// / 65534.
std::vector<std::uint16_t> quantised(std::span<const Real> values, Real low, Real high);

}  // namespace talus
