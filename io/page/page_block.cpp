// The only file that uses zlib.
#include "io/page/page_block.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <new>

namespace talus {

namespace {

constexpr int effort = 6;  // compression level of zlib: 9 takes three times as long for 1 % less

std::string base64_of(std::span<const unsigned char> bytes)
{
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto at = [&](std::size_t k) { return i + k < bytes.size() ? static_cast<std::uint32_t>(bytes[i + k]) : 0U; };
    const std::uint32_t three = at(0) << 16U | at(1) << 8U | at(2);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

std::vector<unsigned char> deflated(std::span<const unsigned char> bytes)
{
  uLongf size = compressBound(bytes.size());
  std::vector<unsigned char> packed(size);
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), effort) != Z_OK)
    throw std::bad_alloc();  // the only possible error
  packed.resize(size);
  return packed;
}

/// The bytes of the values, plane by plane, lowest first.
template <class T>
std::vector<unsigned char> planes_of(std::span<const T> values)
{
  static_assert(std::endian::native == std::endian::little);
  std::vector<unsigned char> planes(values.size_bytes());
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t b = 0; b < sizeof(T); ++b)
    for (std::size_t i = 0; i < values.size(); ++i)
      planes[b * values.size() + i] = bytes[i * sizeof(T) + b];
  return planes;
}

template <class T>
std::vector<T> differences(std::span<const T> values)
{
  std::vector<T> steps(values.begin(), values.end());
  for (std::size_t i = steps.size(); i-- > 1;)
    steps[i] = static_cast<T>(steps[i] - steps[i - 1]);
  return steps;
}

template <class T>
PageBlock block_of(std::string_view type, std::span<const T> values, bool delta)
{
  PageBlock block{type, static_cast<std::int64_t>(values.size()), delta, sizeof(T) > 1, {}};
  block.base64 = base64_of(deflated(planes_of(values)));
  return block;
}

/// Whether differences take fewer bytes, tested on a part from the middle.
bool differences_are_shorter(std::span<const std::uint16_t> values)
{
  constexpr std::size_t tried = 1U << 15U;
  const std::size_t n = std::min(tried, values.size());
  const auto part = values.subspan((values.size() - n) / 2, n);
  const auto steps = differences(part);
  return deflated(planes_of(std::span<const std::uint16_t>(steps))).size() < deflated(planes_of(part)).size();
}

}  // namespace

PageBlock packed(std::span<const std::uint8_t> values) { return block_of("u8", values, false); }

PageBlock packed(std::span<const std::uint16_t> values)
{
  const bool delta = differences_are_shorter(values);
  if (!delta)
    return block_of("u16", values, false);
  const auto steps = differences(values);
  return block_of("u16", std::span<const std::uint16_t>(steps), true);
}

PageBlock packed(std::span<const std::uint32_t> values)
{
  const auto steps = differences(values);
  return block_of("u32", std::span<const std::uint32_t>(steps), true);
}

PageBlock packed(std::span<const float> values) { return block_of("f32", values, false); }

std::vector<std::uint16_t> quantised(std::span<const Real> values, Real low, Real high)
{
  constexpr Real most = 65534;
  constexpr std::uint16_t no_value = 65535;
  const Real scale = high > low ? most / (high - low) : 0;
  std::vector<std::uint16_t> numbers(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Real number = (values[i] - low) * scale;  // not finite if the range is empty
    numbers[i] = std::isfinite(number) ? static_cast<std::uint16_t>(std::lround(std::clamp(number, 0.0, most))) : no_value;
  }
  return numbers;
}

}  // namespace talus
