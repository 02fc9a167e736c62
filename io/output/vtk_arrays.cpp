#include "io/output/vtk_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>

#include "core/error.hpp"
#include "io/output/vtk_blocks.hpp"

namespace talus {

namespace {

constexpr std::string_view array_blanks = " \t\r\n";
constexpr std::uint64_t most_per_packed_byte = 2000;  // most uncompressed bytes per byte of ZLib or LZ4; of LZMA in numbers worth writing

struct VtkNumber {
  std::string_view name;
  std::size_t size;
  Real (*read)(const char* bytes);
};
template <class T>
Real read_as(const char* bytes)
{
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<Real>(value);
}
template <class T>
constexpr VtkNumber number_kind(std::string_view name)
{
  return {name, sizeof(T), read_as<T>};
}
constexpr std::array number_kinds{number_kind<double>("Float64"),       number_kind<float>("Float32"),
                                  number_kind<std::int64_t>("Int64"),   number_kind<std::int32_t>("Int32"),
                                  number_kind<std::int16_t>("Int16"),   number_kind<std::int8_t>("Int8"),
                                  number_kind<std::uint64_t>("UInt64"), number_kind<std::uint32_t>("UInt32"),
                                  number_kind<std::uint16_t>("UInt16"), number_kind<std::uint8_t>("UInt8")};

const VtkNumber* number_kind_of(std::string_view type)
{
  const auto* const found = std::ranges::find(number_kinds, type, &VtkNumber::name);
  return found == number_kinds.end() ? nullptr : found;
}

[[noreturn]] void refuse_array(const std::string& why) { throw EnvironmentError(why); }

/// Reads the numbers of a header one after the other.
class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, bool is_long) : bytes_(bytes), is_long_(is_long) {}
  static std::size_t size_of_number(bool is_long) noexcept { return is_long ? 8 : 4; }
  std::uint64_t next()
  {
    const std::size_t size = size_of_number(is_long_);
    if (bytes_.size() < size)
      refuse_array("it ends before its numbers");
    std::uint64_t value = 0;
    std::memcpy(&value, bytes_.data(), size);  // little-endian
    bytes_.remove_prefix(size);
    return value;
  }
  std::string_view rest() const noexcept { return bytes_; }

 private:
  std::string_view bytes_;
  bool is_long_;
};

/// The uncompressed bytes of `count` blocks, of which the last is shorter unless `last` is 0; nothing if they are more than `most`.
/// Numbers of damaged headers are of any size, so nothing is multiplied that could overflow.
std::optional<std::uint64_t> bytes_of_blocks(std::uint64_t count, std::uint64_t size, std::uint64_t last, std::uint64_t most)
{
  if (count == 0)
    return 0;
  const std::uint64_t whole = last == 0 ? count : count - 1;
  if (size == 0 || last > size || last > most || whole > (most - last) / size)
    return std::nullopt;
  return whole * size + last;
}

std::string unpacked_blocks(HeaderReader header, const std::string& compressor, std::size_t wanted)
{
  const std::uint64_t count = header.next(), size = header.next(), last = header.next();
  if (count > header.rest().size() || bytes_of_blocks(count, size, last, wanted) != wanted)
    refuse_array(fmt::format("it has {} blocks of {} bytes, and its numbers are {} bytes", count, size, wanted));
  if (wanted / most_per_packed_byte > header.rest().size())
    refuse_array("it has more bytes than its blocks can hold");
  std::vector<std::uint64_t> packed;
  for (std::uint64_t b = 0; b < count; ++b)
    packed.push_back(header.next());
  std::string all(wanted, '\0');
  std::string_view rest = header.rest();
  std::size_t at = 0;
  try {
    BlockUnpacker unpack(compressor);
    for (std::uint64_t b = 0; b < count; ++b) {
      const std::size_t bytes = b + 1 == count && last != 0 ? last : size;
      if (packed[b] > rest.size() || bytes > all.size() - at)
        refuse_array("it ends before its numbers");
      if (!unpack(rest.substr(0, packed[b]), std::as_writable_bytes(std::span(all.data() + at, bytes))))
        refuse_array(fmt::format("block {} cannot be unpacked", b + 1));
      rest.remove_prefix(packed[b]);
      at += bytes;
    }
  } catch (const std::invalid_argument& wrong) {
    refuse_array(wrong.what());
  }
  return all;
}

}  // namespace

std::optional<std::size_t> vtk_size_of(std::string_view type)
{
  const VtkNumber* const found = number_kind_of(type);
  return found == nullptr ? std::nullopt : std::optional(found->size);
}

std::vector<Real> numbers_of_text(std::string_view text, std::size_t count)
{
  std::vector<Real> numbers;
  for (std::size_t at = text.find_first_not_of(array_blanks); at != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(array_blanks, at), text.size());
    std::string_view word = text.substr(at, end - at);
    if (word.starts_with('+'))
      word.remove_prefix(1);
    Real value{};
    if (const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        error == std::errc::result_out_of_range && stop == word.data() + word.size())
      value = 0;  // smaller than every number, as other programs write them
    else if (error != std::errc{} || stop != word.data() + word.size())
      refuse_array(fmt::format("number {} is \"{}\"", numbers.size() + 1, word.substr(0, 40)));
    numbers.push_back(value);
    at = text.find_first_not_of(array_blanks, end);
  }
  if (numbers.size() != count)
    refuse_array(fmt::format("it has {} numbers, not {}", numbers.size(), count));
  return numbers;
}

std::string decoded_base64(std::string_view text, std::size_t most)
{
  static constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  static constexpr std::uint8_t no_letter = 255;
  static constexpr auto values = [] {
    std::array<std::uint8_t, 256> all{};
    all.fill(no_letter);
    for (std::uint8_t k = 0; k < letters.size(); ++k)
      all[static_cast<unsigned char>(letters[k])] = k;
    all[static_cast<unsigned char>('=')] = 0;
    return all;
  }();
  std::string bytes;
  bytes.reserve(std::min(most, text.size() / 4 * 3) + 3);
  std::uint32_t bits = 0;
  int held = 0, padding = 0;
  for (const char c : text) {
    if (bytes.size() >= most)
      break;
    const std::uint8_t value = values[static_cast<unsigned char>(c)];
    if (value == no_letter) {
      if (array_blanks.find(c) != array_blanks.npos)
        continue;
      break;
    }
    padding += c == '=' ? 1 : 0;
    bits = bits << 6U | value;
    if (++held < 4)
      continue;
    for (int k = 0; k < 3 - padding; ++k)
      bytes += static_cast<char>(bits >> static_cast<unsigned>(16 - 8 * k) & 0xFFU);
    bits = 0, held = 0, padding = 0;
  }
  if (bytes.size() > most)
    bytes.resize(most);
  return bytes;
}

std::string array_in_base64(std::string_view text, const VtkEncoding& encoding)
{
  const std::size_t number = HeaderReader::size_of_number(encoding.long_headers);
  const std::size_t first = encoding.compressor.empty() ? number : 3 * number;
  const std::string begin = decoded_base64(text, first);
  const std::uint64_t count = HeaderReader(begin, encoding.long_headers).next();  // of bytes, or of blocks
  if (count > text.size())
    refuse_array("it ends before its numbers");
  if (encoding.compressor.empty())
    return decoded_base64(text, number + count);
  const std::string sizes = decoded_base64(text, first + count * number);
  if (sizes.size() < first + count * number)
    refuse_array("it ends before its numbers");
  HeaderReader header(std::string_view(sizes).substr(first), encoding.long_headers);
  std::size_t all = sizes.size();
  for (std::uint64_t b = 0; b < count; ++b) {
    const std::uint64_t packed = header.next();
    if (packed > text.size() || all > text.size())
      refuse_array("it ends before its numbers");
    all += packed;
  }
  return decoded_base64(text, all);
}

std::size_t vtk_count_in_base64(std::string_view text, const VtkEncoding& encoding, std::string_view type)
{
  return vtk_count_of(decoded_base64(text, 3 * sizeof(std::uint64_t)), text.size(), encoding, type);
}

std::size_t vtk_count_of(std::string_view bytes, std::size_t held, const VtkEncoding& encoding, std::string_view type)
{
  HeaderReader header(bytes, encoding.long_headers);
  const std::size_t size = vtk_size_of(type).value_or(1);
  if (encoding.compressor.empty()) {
    const std::uint64_t all = header.next();
    if (all > held)
      refuse_array("it ends before its numbers");
    return all / size;
  }
  const std::uint64_t count = header.next(), block = header.next(), last = header.next();
  const auto all = bytes_of_blocks(count, block, last, held * most_per_packed_byte);
  if (!all)
    refuse_array("it has more bytes than its blocks can hold");
  return *all / size;
}

std::vector<Real> numbers_of_bytes(std::string_view bytes, const VtkEncoding& encoding, std::string_view type, std::size_t count)
{
  const VtkNumber* const kind = number_kind_of(type);
  if (kind == nullptr)
    refuse_array(fmt::format("\"{}\" is no type of numbers", type.substr(0, 40)));
  if (count > std::numeric_limits<std::size_t>::max() / kind->size)
    refuse_array("it claims more numbers than there can be");
  const std::size_t wanted = count * kind->size;
  HeaderReader header(bytes, encoding.long_headers);
  std::string unpacked_bytes;
  std::string_view plain;
  if (encoding.compressor.empty()) {
    if (const std::uint64_t size = header.next(); size != wanted)
      refuse_array(fmt::format("it has {} bytes, not {}", size, wanted));
    plain = header.rest();
    if (plain.size() < wanted)
      refuse_array("it ends before its numbers");
  } else {
    unpacked_bytes = unpacked_blocks(header, encoding.compressor, wanted);
    plain = unpacked_bytes;
  }
  std::vector<Real> numbers(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers[i] = kind->read(plain.data() + i * kind->size);
  return numbers;
}

}  // namespace talus
