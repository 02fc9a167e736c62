#include "io/output/vtk_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/vtk_arrays.hpp"
#include "io/output/xml_tags.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_file(const std::string& why) { throw EnvironmentError(why); }

std::string attribute_of(const XmlTag& tag, std::string_view name)
{
  const std::string* const value = tag.find(name);
  return value == nullptr ? std::string() : *value;
}

std::size_t count_attribute(const XmlTag& tag, std::string_view name)
{
  const std::string text = attribute_of(tag, name);
  std::size_t value = 0;
  if (const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      error != std::errc{} || end != text.data() + text.size())
    refuse_file(fmt::format("{} of <{}> is \"{}\", which is no count", name, tag.name.substr(0, 40), text.substr(0, 40)));
  return value;
}

/// The tags around arrays.  Others occur inside of arrays too, such as <Value> of ranges in an <InformationKey>.
bool is_section(std::string_view tag)
{
  static constexpr std::array<std::string_view, 8> sections{"PointData", "CellData", "Points", "Cells",
                                                            "Verts",     "Lines",    "Strips", "Polys"};
  return std::ranges::find(sections, tag) != sections.end();
}

/// Reads one file from beginning to end.
class VtkPointReader {
 public:
  explicit VtkPointReader(std::string_view bytes) : bytes_(bytes)
  {
    const std::size_t data = bytes.find("<AppendedData");
    head_ = bytes.substr(0, data);
    if (data == bytes.npos)
      return;
    const std::size_t tag_end = bytes.find('>', data), begin = bytes.find('_', std::min(tag_end, bytes.size()));
    if (begin == bytes.npos)
      refuse_file("its appended data do not begin with \"_\"");
    appended_ = bytes.substr(begin + 1);
    const std::string_view tag = bytes.substr(data, tag_end - data);
    appended_raw_ = tag.find("\"raw\"") != tag.npos;
    if (!appended_raw_)
      appended_ = appended_.substr(0, appended_.find('<'));
  }

  VtkPoints read()
  {
    XmlTags tags(head_);
    std::string section;
    while (const auto tag = tags.next()) {
      if (tag->kind == XmlTag::Kind::closes) {
        if (tag->name == "Piece")
          end_piece();
        else if (tag->name == section)
          section.clear();
        continue;
      }
      if (tag->name == "VTKFile")
        begin_file(*tag);
      else if (tag->name == "Piece")
        begin_piece(*tag);
      else if (tag->name == "DataArray" && in_piece_)
        array(*tag, section, tag->kind == XmlTag::Kind::opens ? tags.text() : std::string());
      else if (tag->name == "InformationKey" && last_ != nullptr && attribute_of(*tag, "name") == "UNITS_LABEL")
        last_->unit = tags.text();
      else if (in_piece_ && tag->kind == XmlTag::Kind::opens && is_section(tag->name))
        section = tag->name;
    }
    if (pieces_ == 0)
      refuse_file("it has no <Piece> of points");
    return std::move(all_);
  }

 private:
  void begin_file(const XmlTag& tag)
  {
    const std::string type = attribute_of(tag, "type"), order = attribute_of(tag, "byte_order"), header = attribute_of(tag, "header_type");
    if (type.starts_with('P') && type != "PolyData")
      refuse_file(fmt::format("it is a list of pieces (\"{}\"): name one of the files in it", type.substr(0, 40)));
    if (type != "UnstructuredGrid" && type != "PolyData")
      refuse_file(fmt::format("its type is \"{}\": \"UnstructuredGrid\" (.vtu) and \"PolyData\" (.vtp) can be read", type.substr(0, 40)));
    if (order != "LittleEndian")
      refuse_file(fmt::format("its byte order is \"{}\": only \"LittleEndian\" can be read", order.substr(0, 40)));
    if (!header.empty() && header != "UInt32" && header != "UInt64")
      refuse_file(fmt::format("its header_type is \"{}\", neither \"UInt32\" nor \"UInt64\"", header.substr(0, 40)));
    encoding_ = {header == "UInt64", attribute_of(tag, "compressor")};
    is_grid_ = type == "UnstructuredGrid";
    began_ = true;
  }

  void begin_piece(const XmlTag& tag)
  {
    if (!began_)
      refuse_file("it does not begin with <VTKFile>");
    in_piece_ = true;
    n_points_ = count_attribute(tag, "NumberOfPoints");
    n_cells_ = is_grid_ ? count_attribute(tag, "NumberOfCells") : 0;
    if (n_points_ > bytes_.size() * 1000 || n_cells_ > bytes_.size() * 1000)
      refuse_file("it claims more points than its bytes can hold");
    places_.clear(), connectivity_.clear(), offsets_.clear();
  }

  void array(const XmlTag& tag, const std::string& section, const std::string& inline_text)
  {
    last_ = nullptr;
    const std::string type = attribute_of(tag, "type"), name = attribute_of(tag, "Name");
    const bool by_point = section == "PointData" || section == "Points", by_cell = section == "CellData" && is_grid_;
    const bool shapes = section == "Cells" && is_grid_ && (name == "connectivity" || name == "offsets");
    if ((!by_point && !by_cell && !shapes) || !vtk_size_of(type))
      return;
    const auto components = tag.find("NumberOfComponents") == nullptr ? 1 : count_attribute(tag, "NumberOfComponents");
    constexpr std::size_t most_field_components = 1000;
    if (components < 1 || components > most_field_components)
      refuse_file(fmt::format("array \"{}\" has {} components", name.substr(0, 40), components));
    std::vector<Real> numbers;
    try {
      const std::size_t items = by_point ? n_points_ : shapes && name == "connectivity" ? n_corners(tag, type, inline_text) : n_cells_;
      numbers = numbers_of(tag, type, inline_text, items * components);
    } catch (const EnvironmentError& wrong) {
      refuse_file(fmt::format("array \"{}\": {}", name.substr(0, 40), wrong.what()));
    }
    if (section == "Points") {
      if (components != 3)
        refuse_file(fmt::format("its points have {} coordinates, not 3", components));
      places_ = std::move(numbers);
    } else if (shapes) {
      (name == "offsets" ? offsets_ : connectivity_) = std::move(numbers);
    } else {
      add(by_point ? all_.of_points : all_.of_cells, tag, name, static_cast<int>(components), std::move(numbers));
    }
  }

  /// The number of corners of all cells: no tag has it, so it is that of the bytes or words of the array.
  std::size_t n_corners(const XmlTag& tag, const std::string& type, const std::string& inline_text) const
  {
    if (attribute_of(tag, "format") == "ascii") {
      std::size_t words = 0;
      bool in_word = false;
      for (const char c : inline_text) {
        const bool is_blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        words += !is_blank && !in_word ? 1 : 0;
        in_word = !is_blank;
      }
      return words;
    }
    const auto [bytes, is_base64] = source_of(tag, inline_text);
    return is_base64 ? vtk_count_in_base64(bytes, encoding_, type) : vtk_count_of(bytes, bytes.size(), encoding_, type);
  }

  /// Where an array begins that is not written as numbers: its bytes or base64, and behind it that of others.
  struct ArraySource {
    std::string_view bytes;
    bool is_base64;
  };
  ArraySource source_of(const XmlTag& tag, const std::string& inline_text) const
  {
    const std::string format = attribute_of(tag, "format");
    if (format == "binary")
      return {inline_text, true};
    if (format != "appended")
      refuse_file(fmt::format("its format is \"{}\": \"ascii\", \"binary\" and \"appended\" can be read", format.substr(0, 40)));
    const std::size_t offset = count_attribute(tag, "offset");
    if (offset >= appended_.size())
      refuse_file("its numbers are not in the file");
    return {appended_.substr(offset), !appended_raw_};
  }

  std::vector<Real> numbers_of(const XmlTag& tag, const std::string& type, const std::string& inline_text, std::size_t count) const
  {
    if (attribute_of(tag, "format") == "ascii")
      return numbers_of_text(inline_text, count);
    const auto [bytes, is_base64] = source_of(tag, inline_text);
    return is_base64 ? numbers_of_bytes(array_in_base64(bytes, encoding_), encoding_, type, count)
                     : numbers_of_bytes(bytes, encoding_, type, count);
  }

  void add(std::vector<VtkField>& fields, const XmlTag& tag, const std::string& name, int components, std::vector<Real> numbers)
  {
    const auto found = std::ranges::find(fields, name, &VtkField::name);
    const bool is_new = found == fields.end();
    if (is_new && pieces_ > 0)
      refuse_file(fmt::format("piece {} has a field \"{}\", and others have not", pieces_ + 1, name.substr(0, 40)));
    VtkField& field = is_new ? fields.emplace_back() : *found;
    if (!is_new && field.components != components)
      refuse_file(
          fmt::format("field \"{}\" has {} components in one place and {} in another", name.substr(0, 40), field.components, components));
    field.name = name;
    field.components = components;
    field.values.insert(field.values.end(), numbers.begin(), numbers.end());
    if (field.component_names.empty())
      for (int c = 0; c < components && tag.find(fmt::format("ComponentName{}", c)) != nullptr; ++c)
        field.component_names.push_back(attribute_of(tag, fmt::format("ComponentName{}", c)));
    if (field.component_names.size() != static_cast<std::size_t>(components))
      field.component_names.clear();
    last_ = &field;
  }

  void end_piece()
  {
    if (places_.size() != 3 * n_points_ || (n_cells_ > 0 && offsets_.size() != n_cells_))
      refuse_file("it has no points or no cells");
    all_.points.insert(all_.points.end(), places_.begin(), places_.end());
    std::size_t begin = 0;
    for (std::size_t c = 0; c < n_cells_; ++c) {
      const Real offset = offsets_[c];  // of a damaged file: anything, also what no whole number can be
      if (!(offset > static_cast<Real>(begin)) || !(offset <= static_cast<Real>(connectivity_.size())) || offset != std::floor(offset))
        refuse_file(fmt::format("cell {} has no corners", c + 1));
      const auto end = static_cast<std::size_t>(offset);
      std::array<Real, 3> mean{};
      for (std::size_t k = begin; k < end; ++k) {
        if (!(connectivity_[k] >= 0) || !(connectivity_[k] < static_cast<Real>(n_points_)))
          refuse_file(fmt::format("cell {} has the corner {}, of {} points", c + 1, connectivity_[k], n_points_));
        for (std::size_t d = 0; d < 3; ++d)
          mean[d] += places_[3 * static_cast<std::size_t>(connectivity_[k]) + d];
      }
      for (const Real sum : mean)
        all_.cells.push_back(sum / static_cast<Real>(end - begin));
      begin = end;
    }
    ++pieces_;
    in_piece_ = false;
    check(all_.of_points, all_.points.size() / 3);
    check(all_.of_cells, all_.cells.size() / 3);
  }

  void check(const std::vector<VtkField>& fields, std::size_t items) const
  {
    for (const VtkField& field : fields)
      if (field.values.size() != items * static_cast<std::size_t>(field.components))
        refuse_file(fmt::format("piece {} has no field \"{}\", and others have", pieces_, field.name.substr(0, 40)));
  }

  std::string_view bytes_, head_, appended_;
  bool appended_raw_ = false, is_grid_ = false, began_ = false, in_piece_ = false;
  VtkEncoding encoding_;
  std::size_t n_points_ = 0, n_cells_ = 0, pieces_ = 0;
  std::vector<Real> places_, connectivity_, offsets_;
  VtkPoints all_;
  VtkField* last_ = nullptr;
};

}  // namespace

VtkPoints read_vtk_points(const fs::path& file)
{
  const std::string bytes = read_whole(file);
  try {
    return VtkPointReader(bytes).read();
  } catch (const EnvironmentError& wrong) {
    throw EnvironmentError(fmt::format("cannot read {}: {}", file.string(), wrong.what()));
  }
}

}  // namespace talus
