#include "io/output/vtk_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <optional>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk_blocks.hpp"
#include "io/output/xml_tags.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view data_section = "AppendedData";
constexpr std::uint64_t largest_block = 0x7E000000;  // largest uncompressed block of LZ4 [bytes]
constexpr std::uint64_t most_from_one = 255;         // most uncompressed bytes per byte of LZ4
constexpr int most_components = 100;                 // Talus writes 1, 3, 6 and 9

/// The size of a number [bytes]; zero for a type that Talus does not write.
std::size_t size_of(std::string_view type)
{
  return type == "Float64" || type == "Int64" ? 8 : type == "Float32" || type == "Int32" ? 4 : type == "UInt8" ? 1 : 0;
}

template <class T>
std::optional<T> whole_number(const std::string* text)
{
  T value{};
  if (text == nullptr)
    return std::nullopt;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  return error == std::errc{} && end == text->data() + text->size() && value >= 0 ? std::optional(value) : std::nullopt;
}

std::string quoted_value(const std::string* text) { return text == nullptr ? "nothing" : '"' + text->substr(0, 40) + '"'; }

template <class T>
std::vector<Real> widened(std::span<const std::byte> bytes)
{
  std::vector<Real> numbers(bytes.size() / sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    T value{};
    std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof(T));
    numbers[i] = static_cast<Real>(value);
  }
  return numbers;
}

}  // namespace

VtkLayout::VtkLayout(const fs::path& file, std::string_view kind) : file_(file)
{
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored))
    throw EnvironmentError(fmt::format("cannot read {}: there is no such file", file.string()));
  bytes_ = read_whole(file);
  try {
    read_head(kind);
    check_sizes();
  } catch (const EnvironmentError& wrong) {
    throw EnvironmentError(fmt::format("cannot read {}: it is damaged, or not written by talus: {}", file.string(), wrong.what()));
  }
}

void VtkLayout::fail(const std::string& why) const
{
  throw EnvironmentError(fmt::format("cannot read {}: it is damaged: {}", file_.string(), why));
}

/// Reads the XML header.  Errors do not contain the name of the file.
void VtkLayout::read_head(std::string_view kind)
{
  const std::string_view all = bytes_;
  const std::size_t data = all.find(fmt::format("<{} encoding=\"raw\">", data_section));
  const std::size_t begin = data == all.npos ? data : all.find('_', data);
  if (begin == all.npos)
    throw EnvironmentError(fmt::format("it has no section <{} encoding=\"raw\">", data_section));
  XmlTags tags(all.substr(0, data));
  std::vector<std::string_view> open;
  VtkArray* described = nullptr;
  bool has_piece = false;
  while (const auto tag = tags.next()) {
    if (tag->kind == XmlTag::Kind::closes) {
      if (open.empty() || open.back() != tag->name)
        throw EnvironmentError(fmt::format("</{}> closes nothing", tag->name.substr(0, 40)));
      open.pop_back();
      described = nullptr;
      continue;
    }
    const std::string section(open.empty() ? "" : open.back());
    if (open.empty() && tag->name == "VTKFile") {
      for (const auto& [name, wanted] : {std::pair<std::string_view, std::string_view>{"type", kind},
                                         {"byte_order", "LittleEndian"},
                                         {"header_type", "UInt64"},
                                         {"compressor", "vtkLZ4DataCompressor"}})
        if (const std::string* const value = tag->find(name); value == nullptr || *value != wanted)
          throw EnvironmentError(fmt::format("{} is {}, not \"{}\"", name, quoted_value(value), wanted));
    } else if (tag->name == "Piece") {
      const auto count_of = [&](std::string_view name) {
        const auto count = whole_number<std::int64_t>(tag->find(name));
        if (!count)
          throw EnvironmentError(fmt::format("{} is {}, which is no count", name, quoted_value(tag->find(name))));
        return static_cast<std::size_t>(*count);
      };
      if (has_piece)
        throw EnvironmentError("it has several pieces");
      has_piece = true;
      n_points_ = count_of("NumberOfPoints");
      has_cells_ = kind == "UnstructuredGrid";
      n_cells_ = has_cells_ ? count_of("NumberOfCells") : 0;
    } else if (tag->name == "DataArray" || tag->name == "Array") {
      const auto text_of = [&](std::string_view name) { return tag->find(name) == nullptr ? std::string() : *tag->find(name); };
      VtkArray array{section, text_of("Name"), text_of("type"), 1, {}, {}};
      const std::string* const components = tag->find("NumberOfComponents");
      array.components = components == nullptr ? 1 : whole_number<int>(components).value_or(0);
      if (array.components < 1 || array.components > most_components)
        throw EnvironmentError(fmt::format("NumberOfComponents of \"{}\" is {}", array.name.substr(0, 40), quoted_value(components)));
      const bool is_text = tag->name == "Array" && array.type == "String";
      if (array.name.empty() || (!is_text && size_of(array.type) == 0))
        throw EnvironmentError(fmt::format("an array \"{}\" of the type \"{}\"", array.name.substr(0, 40), array.type.substr(0, 40)));
      if (section == "FieldData" && whole_number<std::int64_t>(tag->find("NumberOfTuples")) != 1)
        throw EnvironmentError(
            fmt::format("NumberOfTuples of \"{}\" is {}", array.name.substr(0, 40), quoted_value(tag->find("NumberOfTuples"))));
      const auto offset = whole_number<std::size_t>(tag->find("offset"));
      if (text_of("format") != "appended" || !offset || *offset >= bytes_.size())
        throw EnvironmentError(fmt::format("the numbers of \"{}\" are not in the file", array.name.substr(0, 40)));
      array.blocks = blocks_at(begin + 1 + *offset);
      arrays_.push_back(std::move(array));
      described = tag->kind == XmlTag::Kind::opens ? &arrays_.back() : nullptr;
    } else if (tag->name == "InformationKey" && described != nullptr && tag->kind == XmlTag::Kind::opens) {
      if (const std::string* const key = tag->find("name"); key != nullptr && *key == "UNITS_LABEL")
        described->unit = tags.text();
    }
    if (tag->kind == XmlTag::Kind::opens)
      open.push_back(tag->name);
  }
  if (!has_piece)
    throw EnvironmentError(fmt::format("it has no <Piece> of <{}>", kind));
}

/// The blocks that begin at a position, if they lie in the file and none of them claims a larger uncompressed size than LZ4 can reach.
VtkBlocks VtkLayout::blocks_at(std::size_t at) const
{
  const auto refuse = [](std::string_view what) { throw EnvironmentError(std::string(what)); };
  std::array<std::uint64_t, 3> head{};
  if (at > bytes_.size() || bytes_.size() - at < sizeof head)
    refuse("it ends before its numbers");
  std::memcpy(head.data(), bytes_.data() + at, sizeof head);
  VtkBlocks blocks{at + sizeof head, 0, head[0], head[1], head[2]};
  std::uint64_t room = bytes_.size() - blocks.sizes;
  if (blocks.count > room / sizeof(std::uint64_t))
    refuse("it ends before its numbers");
  if (blocks.count == 0 ? blocks.last_size != 0 : blocks.size == 0 || blocks.size > largest_block || blocks.last_size > blocks.size)
    refuse("an array has blocks of no size");
  room -= blocks.count * sizeof(std::uint64_t);
  blocks.bytes = blocks.sizes + blocks.count * sizeof(std::uint64_t);
  for (std::uint64_t b = 0; b < blocks.count; ++b) {
    std::uint64_t packed = 0;
    std::memcpy(&packed, bytes_.data() + blocks.sizes + b * sizeof packed, sizeof packed);
    const std::uint64_t size = b + 1 == blocks.count && blocks.last_size != 0 ? blocks.last_size : blocks.size;
    if (packed > room)
      refuse("it ends before its numbers");
    if (size / most_from_one > packed)
      refuse("an array has blocks that are larger than what is in them");
    room -= packed;
  }
  return blocks;
}

/// Compares the sizes of arrays.  Errors do not contain the name of the file.
void VtkLayout::check_sizes() const
{
  std::uint64_t together = 0;
  for (const VtkArray& array : arrays_) {
    together += array.blocks.unpacked();
    if (together / most_from_one > bytes_.size())
      throw EnvironmentError("several arrays share their bytes");
    if (array.type == "String")
      continue;
    const std::size_t row = size_of(array.type) * static_cast<std::size_t>(array.components);
    const bool by_point = array.section == "PointData" || array.section == "Points", by_cell = array.section == "CellData" && has_cells_;
    const std::uint64_t unpacked = array.blocks.unpacked(), rows = unpacked / row;
    if (unpacked % row != 0 || (by_point && rows != n_points_) || (by_cell && rows != n_cells_) ||
        (array.section == "FieldData" && rows != 1))
      throw EnvironmentError(fmt::format("\"{}\" has {} bytes, which are not {} rows of {}", array.name.substr(0, 40), unpacked,
                                         by_point  ? n_points_
                                         : by_cell ? n_cells_
                                                   : rows,
                                         row));
  }
  const VtkArray* const points = find("Points", "Points");
  if (points == nullptr || points->type != "Float64" || points->components != 3)
    throw EnvironmentError("it has no positions");
}

const VtkArray* VtkLayout::find(std::string_view section, std::string_view name) const noexcept
{
  const auto found = std::ranges::find_if(arrays_, [&](const VtkArray& array) { return array.section == section && array.name == name; });
  return found == arrays_.end() ? nullptr : &*found;
}

std::vector<std::byte> VtkLayout::unpacked(const VtkArray& array) const
{
  const VtkBlocks& blocks = array.blocks;
  std::vector<std::byte> all(blocks.unpacked());
  BlockUnpacker unpack("vtkLZ4DataCompressor");
  const char* from = bytes_.data() + blocks.bytes;
  std::byte* to = all.data();
  for (std::uint64_t b = 0; b < blocks.count; ++b) {
    std::uint64_t packed = 0;
    std::memcpy(&packed, bytes_.data() + blocks.sizes + b * sizeof packed, sizeof packed);
    const std::uint64_t size = std::min<std::uint64_t>(blocks.size, static_cast<std::uint64_t>(all.data() + all.size() - to));
    if (!unpack({from, packed}, {to, size}))
      fail(fmt::format("block {} of \"{}\" cannot be unpacked", b + 1, array.name));
    from += packed;
    to += size;
  }
  return all;
}

std::vector<Real> VtkLayout::numbers(const VtkArray& array) const
{
  const std::vector<std::byte> bytes = unpacked(array);
  if (array.type == "Float64")
    return widened<double>(bytes);
  if (array.type == "Float32")
    return widened<float>(bytes);
  if (array.type == "Int64")
    return widened<std::int64_t>(bytes);
  if (array.type == "Int32")
    return widened<std::int32_t>(bytes);
  return widened<std::uint8_t>(bytes);
}

std::vector<std::int64_t> VtkLayout::whole_numbers(const VtkArray& array) const
{
  if (array.type != "Int64" && array.type != "Int32")
    fail(fmt::format("\"{}\" is of the type {}", array.name, array.type));
  const std::vector<std::byte> bytes = unpacked(array);
  std::vector<std::int64_t> numbers(bytes.size() / size_of(array.type));
  if (array.type == "Int64" && !numbers.empty())
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
  for (std::size_t i = 0; array.type == "Int32" && i < numbers.size(); ++i) {
    std::int32_t value = 0;
    std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
    numbers[i] = value;
  }
  return numbers;
}

std::string VtkLayout::text(const VtkArray& array) const
{
  const std::vector<std::byte> bytes = unpacked(array);
  const std::string all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return all.substr(0, all.find('\0'));
}

}  // namespace talus
