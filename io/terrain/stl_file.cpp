#include "io/terrain/stl_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

// Binary format: a header without meaning, the number of triangles, and for each the normal, three corners and two more bytes.
constexpr std::size_t heading = 80, per_triangle = 50;

template <class T>
T value_at(std::string_view bytes, std::size_t at)
{
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

[[noreturn]] void refuse(const std::filesystem::path& file, int line, const std::string& what)
{
  throw SceneErrors({file.string(), line, line > 0 ? 1 : 0, ""}, what);
}

void add_corner(const std::array<Real, 3>& corner, TriangleSheet& sheet)
{
  const auto c = static_cast<Index>(sheet.corners.size());
  if (c % 3 == 0)
    sheet.triangles.push_back({c, c + 1, c + 2});
  sheet.corners.push_back(corner);
}

TriangleSheet read_binary(std::string_view bytes, const std::filesystem::path& file)
{
  TriangleSheet sheet;
  for (std::size_t at = heading + 4; at < bytes.size(); at += per_triangle)
    for (std::size_t a = 0; a < 3; ++a) {
      std::array<Real, 3> corner{};
      for (std::size_t d = 0; d < 3; ++d)
        corner[d] = static_cast<Real>(value_at<float>(bytes, at + 12 * (a + 1) + 4 * d));
      if (!std::isfinite(corner[0]) || !std::isfinite(corner[1]) || !std::isfinite(corner[2]))
        refuse(file, 0, fmt::format("a corner of the triangle at byte {} is not finite", at));
      add_corner(corner, sheet);
    }
  return sheet;
}

/// Removes and returns the first word; blanks before it are removed too.
std::string_view take_word(std::string_view& line)
{
  constexpr auto between = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(between), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(between));
  line.remove_prefix(word.size());
  return word;
}

TriangleSheet read_ascii(std::string_view text, const std::filesystem::path& file)
{
  TriangleSheet sheet;
  int number = 1;
  for (; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::string_view what = take_word(line);
    if (what != "vertex") {
      if (what == "endfacet" && sheet.corners.size() % 3 != 0)
        refuse(file, number, "a facet has three corners");
      continue;
    }
    std::array<Real, 3> corner{};
    for (Real& x : corner) {
      const std::string_view word = take_word(line);
      const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), x);
      if (code != std::errc{} || end != word.data() + word.size() || !std::isfinite(x))
        refuse(file, number, fmt::format("'{}' is no coordinate of a corner", word));
    }
    add_corner(corner, sheet);
  }
  if (sheet.corners.size() % 3 != 0)
    refuse(file, number, "the file ends within a facet");
  return sheet;
}

}  // namespace

TriangleSheet read_stl(const std::filesystem::path& file)
{
  const std::string bytes = read_whole(file);
  const std::size_t told = bytes.size() < heading + 4 ? 0 : value_at<std::uint32_t>(bytes, heading);
  // Binary files may begin with the first word of the ASCII format.
  const bool is_binary = bytes.size() >= heading + 4 && bytes.size() == heading + 4 + told * per_triangle;
  if (!is_binary && (!bytes.starts_with("solid") || bytes.find('\0') != bytes.npos))
    refuse(file, 0,
           bytes.size() < heading + 4 ? "this is no STL file: it neither begins with 'solid' nor has the heading of a binary one"
                                      : fmt::format("of {} triangles of a binary STL file there would be {} bytes, not {}", told,
                                                    heading + 4 + told * per_triangle, bytes.size()));
  TriangleSheet sheet = is_binary ? read_binary(bytes, file) : read_ascii(bytes, file);
  if (sheet.triangles.empty())
    refuse(file, 0, "there is no triangle in it");
  return sheet;
}

}  // namespace talus
