#include "io/terrain/raster_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/terrain/gdal_plugin.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

// The text of an ESRI ASCII grid is checked before GDAL reads it: GDAL reads a word as the elevation 0 and ignores superfluous values.
constexpr std::array<std::string_view, 10> grid_keys{"ncols",     "nrows", "xllcorner", "yllcorner", "xllcenter",
                                                     "yllcenter", "dx",    "dy",        "cellsize",  "nodata_value"};

std::string lower_case(std::string_view text)
{
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return small;
}

bool is_key(std::string_view word) { return std::find(grid_keys.begin(), grid_keys.end(), lower_case(word)) != grid_keys.end(); }

/// A number in the notation of GDAL: with a point or a comma, "nan", "inf" and the notation of Windows for them ("-1.#IND").
std::optional<Real> grid_number(std::string text)
{
  if (text.starts_with('+'))
    text.erase(0, 1);
  const std::string small = lower_case(text.starts_with('-') ? text.substr(1) : text);
  if (small == "nan" || small == "inf" || small == "infinity" || small.starts_with("1.#"))
    return std::nan("");
  if (const auto comma = text.find(','); comma != text.npos)
    text[comma] = '.';
  Real value{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  // Very long numbers are valid too, as zero or infinity.
  return (code == std::errc{} || code == std::errc::result_out_of_range) && end == text.data() + text.size() ? std::optional(value)
                                                                                                             : std::nullopt;
}

/// A word of the text with its position.
struct GridWord {
  std::string text;
  int line = 1, column = 1;
  bool begins_line = false;
};

/// The words of a file, read piece by piece, because a grid may be larger than the free memory.
class GridWords {
 public:
  explicit GridWords(const fs::path& file) : stream_(file, std::ios::binary) { buffer_.resize(1 << 18); }

  /// Reads the next word; false at the end.  A word longer than any number comes in pieces.
  bool next(GridWord& word)
  {
    constexpr std::size_t longest = 400;
    word.text.clear();
    bool only_blanks = column_ == 1;
    for (;;) {
      if (at_ == end_ && !fill())
        return !word.text.empty();
      const char c = buffer_[at_];
      const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
      if (!word.text.empty() && (blank || word.text.size() == longest))
        return true;
      if (!blank) {
        if (word.text.empty()) {
          word.line = line_, word.column = column_;
          word.begins_line = only_blanks;
        }
        word.text += c;
      }
      ++at_, ++column_;
      if (c == '\n')
        ++line_, column_ = 1, only_blanks = true;
    }
  }

 private:
  bool fill()
  {
    stream_.read(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    at_ = 0;
    end_ = static_cast<std::size_t>(stream_.gcount());
    return end_ > 0;
  }

  std::ifstream stream_;
  std::string buffer_;
  std::size_t at_ = 0, end_ = 0;
  int line_ = 1, column_ = 1;
};

std::string shown_word(const std::string& text)
{
  constexpr std::size_t most = 40;
  std::string plain = text.substr(0, most);
  std::replace_if(
      plain.begin(), plain.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7F; }, '?');
  return plain + (text.size() > most ? "..." : "");
}

/// Whether the file begins with a key of an ESRI ASCII grid, by the same test as GDAL's; the name does not matter.  False if it cannot be
/// opened.
bool is_ascii_grid(const fs::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  std::string begin(16, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  begin.erase(0, std::min(begin.find_first_not_of(" \t\r\n"), begin.size()));
  return is_key(begin.substr(0, begin.find_first_of(" \t\r\n")));
}

/// The ignored parts of the file, one sentence each, such as values after the last row.  Throws SceneErrors with line and column for words
/// that are not numbers.  "nan" and "inf" are cells without a value.
std::vector<std::string> check_ascii_grid(const fs::path& file)
{
  std::vector<SceneError> problems;
  constexpr std::size_t most_problems = 20;  // a file of another kind has an error in every word
  const auto complain = [&](const GridWord& word, const std::string& what) {
    problems.push_back({{file.string(), word.line, word.column, ""}, what, {}});
  };
  GridWords words(file);
  GridWord word;
  bool more = words.next(word);
  Real cells = 1;
  for (; more && is_key(word.text); more = words.next(word)) {
    const std::string key = lower_case(word.text);
    if (!words.next(word))
      break;
    const auto value = grid_number(word.text);
    if (!value)
      complain(word, fmt::format("{} is '{}', which is no number", key, shown_word(word.text)));
    else if (key == "ncols" || key == "nrows")
      cells *= *value;
  }
  if (more && word.begins_line && std::isalpha(static_cast<unsigned char>(word.text.front())) != 0)
    complain(word, fmt::format("'{}' begins the first row: a reader would take the row for a part of the heading; write the NODATA_value "
                               "for a cell without a value",
                               shown_word(word.text)));
  Real values = 0;
  std::optional<GridWord> surplus;
  for (; more && problems.size() < most_problems; more = words.next(word)) {
    if (!grid_number(word.text))
      complain(word, fmt::format("'{}' is no number", shown_word(word.text)));
    if (values++ == cells)
      surplus = word;
  }
  if (!problems.empty())
    throw SceneErrors(problems);
  if (!surplus)
    return {};
  return {fmt::format("{:.0f} value{} after the last row {} passed over; the first is '{}' in line {}: are ncols and nrows right?",
                      values - cells, values - cells == 1 ? "" : "s", values - cells == 1 ? "is" : "are", shown_word(surplus->text),
                      surplus->line)};
}

std::string as_table(const Raster& raster)
{
  std::string text = fmt::format("x [m],y [m],value{}\n", raster.unit.empty() ? "" : " [" + raster.unit + "]");
  for (Index r = 0; r < raster.rows; ++r)
    for (Index c = 0; c < raster.columns; ++c)
      if (const Real value = raster.at(c, r); std::isfinite(value))
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", raster.west + (static_cast<Real>(c) + 0.5) * raster.dx,
                       raster.south + (static_cast<Real>(r) + 0.5) * raster.dy, value);
  return text;
}

std::string as_ascii_grid(const Raster& raster)
{
  constexpr Real same = 1e-9;
  if (std::abs(raster.dx - raster.dy) > same * raster.dx)
    throw EnvironmentError(
        fmt::format("cells of {:g} m by {:g} m are no squares, which an ESRI ASCII grid wants: write a .tif", raster.dx, raster.dy));
  std::string text = fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value -9999\n", raster.columns,
                                 raster.rows, raster.west, raster.south, raster.dx);
  for (Index r = raster.rows; r-- > 0;)
    for (Index c = 0; c < raster.columns; ++c) {
      const Real value = raster.at(c, r);
      fmt::format_to(std::back_inserter(text), "{}{}", std::isfinite(value) ? static_cast<float>(value) : -9999.0F,
                     c + 1 < raster.columns ? ' ' : '\n');
    }
  return text;
}

}  // namespace

Raster read_raster(const fs::path& file, std::vector<std::string>* passed_over)
{
  const GdalPart& part = gdal();
  if (!not_ordinary(file) && is_ascii_grid(file)) {
    std::vector<std::string> found = check_ascii_grid(file);
    if (passed_over != nullptr)
      *passed_over = std::move(found);
  }
  return part.read_raster(file);
}

void write_raster(const fs::path& file, const Raster& raster)
{
  const std::string kind = file.extension().string();
  try {
    if (kind == ".tif" || kind == ".tiff")
      write_whole(file, [&](const fs::path& temporary) { gdal().write_geotiff(temporary, raster); });
    else if (kind == ".asc") {
      write_whole(file, as_ascii_grid(raster));
      if (!raster.crs.empty())
        write_whole(fs::path(file).replace_extension(".prj"), gdal().esri_text(raster.crs) + "\n");
    } else if (kind == ".csv")
      write_whole(file, as_table(raster));
    else
      throw EnvironmentError(fmt::format("maps are .tif, .asc or .csv, not '{}'", kind));
  } catch (const EnvironmentError& wrong) {
    const std::string_view text = wrong.what();
    throw text.find(file.string()) != text.npos ? wrong : EnvironmentError(fmt::format("cannot write {}: {}", file.string(), text));
  }
}

}  // namespace talus
