// Files have the layout of VTK's own writers; they are written here so that several ranks can write one together.
#include "io/output/vtk.hpp"

#include <fmt/format.h>
#include <vtkCellType.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkNew.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "core/error.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view id_name = "id", origin_name = "MadeBy";

/// The header of an array in the appended data of a file with header_type="UInt64" and a compressor.
struct BlockHeader {
  std::uint64_t blocks, size, last_size;  ///< number of blocks, uncompressed bytes of each, bytes of the last one if it is shorter
};

/// An array of which every rank has some rows, or the root all bytes.
struct PartOfArray {
  std::span<const std::byte> bytes;
  std::uint64_t first, of_all;  ///< position of the first byte of this rank, bytes of all ranks
};

/// The compressed blocks of this rank, one after the other.
struct PackedBlocks {
  std::vector<std::uint64_t> sizes;
  std::vector<std::byte> bytes;
};

PackedBlocks pack_blocks(std::span<const std::byte> bytes, std::uint64_t block_bytes)
{
  vtkNew<vtkLZ4DataCompressor> compressor;  // it keeps no state between blocks
  const std::size_t room = compressor->GetMaximumCompressionSpace(block_bytes);
  const std::size_t n = (bytes.size() + block_bytes - 1) / block_bytes;
  PackedBlocks blocks{std::vector<std::uint64_t>(n), std::vector<std::byte>(n * room)};
  parallel_for(static_cast<Index>(n), [&](Index i) {
    const auto block = static_cast<std::size_t>(i);
    const auto from = bytes.subspan(block * block_bytes, std::min<std::size_t>(block_bytes, bytes.size() - block * block_bytes));
    blocks.sizes[block] = compressor->Compress(reinterpret_cast<const unsigned char*>(from.data()), from.size(),
                                               reinterpret_cast<unsigned char*>(blocks.bytes.data() + block * room), room);
  });
  std::size_t end = 0;
  for (std::size_t i = 0; i < n; ++i) {
    std::memmove(blocks.bytes.data() + end, blocks.bytes.data() + i * room, blocks.sizes[i]);
    end += blocks.sizes[i];
  }
  blocks.bytes.resize(end);
  return blocks;
}

/// Writes an array at its position: header, compressed sizes of all blocks, the blocks.  Returns the end of the array.
std::uint64_t put_array(Communicator& ranks, const PutBytes& put, std::uint64_t at, const PartOfArray& array, std::uint64_t block_bytes)
{
  const PackedBlocks mine = pack_blocks(array.bytes, block_bytes);
  const BlockHeader header{(array.of_all + block_bytes - 1) / block_bytes, block_bytes, array.of_all % block_bytes};
  if (ranks.is_root())
    put(at, std::as_bytes(std::span(&header, 1)));
  const std::uint64_t sizes = at + sizeof header;
  put(sizes + array.first / block_bytes * sizeof(std::uint64_t), std::as_bytes(std::span(mine.sizes)));
  std::uint64_t here = sizes + header.blocks * sizeof(std::uint64_t), end = here;
  const auto all = of_all_ranks(ranks, static_cast<std::int64_t>(mine.bytes.size()));
  for (std::size_t r = 0; r < all.size(); ++r) {
    here += std::cmp_less(r, ranks.rank()) ? static_cast<std::uint64_t>(all[r]) : 0;
    end += static_cast<std::uint64_t>(all[r]);
  }
  put(here, mine.bytes);
  return end;
}

std::string escaped(const std::string& text)
{
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

template <class T>
constexpr std::string_view vtk_type()
{
  if constexpr (std::is_same_v<T, double>)
    return "Float64";
  else if constexpr (std::is_same_v<T, float>)
    return "Float32";
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return "Int64";
  else if constexpr (std::is_same_v<T, std::int32_t>)
    return "Int32";
  else {
    static_assert(std::is_same_v<T, std::uint8_t>);
    return "UInt8";
  }
}

/// A VTK file in XML as written by all ranks: lines of text, followed by the arrays that they name, in blocks compressed with LZ4.  Every
/// rank makes the same calls, with its slice of each array.
class XmlFile {
 public:
  explicit XmlFile(Communicator& ranks, std::string_view kind, std::int64_t block_bytes)
      : ranks_(ranks), kind_(kind), block_bytes_(static_cast<std::uint64_t>(block_bytes))
  {
    line(0, fmt::format("<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
                        "compressor=\"vtkLZ4DataCompressor\">",
                        kind));
    line(2, fmt::format("<{}>", kind));
  }

  void line(std::size_t indent, std::string_view text) { head_ += std::string(indent, ' ') + std::string(text) + '\n'; }

  /// Adds an array of which `slice` describes the rows here.  `values` must stay valid until the file is written.
  template <class T>
  void array(std::string_view name, std::span<const T> values, int components, const Slice& slice, const std::string& unit = {})
  {
    std::string words = fmt::format("<DataArray type=\"{}\" Name=\"{}\"", vtk_type<T>(), escaped(std::string(name)));
    if (components > 1)
      words += fmt::format(" NumberOfComponents=\"{}\"", components);
    const auto row_bytes = static_cast<std::uint64_t>(components) * sizeof(T);
    add(words,
        {std::as_bytes(values), static_cast<std::uint64_t>(slice.first) * row_bytes, static_cast<std::uint64_t>(slice.of_all) * row_bytes});
    if (unit.empty()) {
      head_ += "/>\n";
      return;
    }
    head_ += ">\n";
    line(10, "<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">");
    line(12, escaped(unit));
    line(10, "</InformationKey>");
    line(8, "</DataArray>");
  }
  template <class T>
  void array(std::string_view name, const std::vector<T>& values, int components, const Slice& slice, const std::string& unit = {})
  {
    array(name, std::span<const T>(values), components, slice, unit);
  }

  /// Adds the time and the program.  Both must stay valid too.
  void origin(const Real& time, const std::string& made_by)
  {
    line(4, "<FieldData>");
    of_root("<DataArray type=\"Float64\" Name=\"TimeValue\"", std::as_bytes(std::span(&time, 1)));  // the name that ParaView looks for
    if (!made_by.empty())
      of_root(fmt::format("<Array type=\"String\" Name=\"{}\"", origin_name),
              std::as_bytes(std::span(made_by.c_str(), made_by.size() + 1)));
    line(4, "</FieldData>");
  }

  void columns(std::string_view section, std::span<const Column> columns, const Slice& slice)
  {
    for (const Column& column : columns)
      array(column.name, column.values, column.components, slice, column.unit);
    line(6, fmt::format("</{}>", section));
  }

  void write(const fs::path& file)
  {
    line(4, "</Piece>");
    line(2, fmt::format("</{}>", kind_));
    line(2, "<AppendedData encoding=\"raw\">");
    head_ += "   _";
    write_together(
        ranks_, file, [](const fs::path&) {},
        [&](const PutBytes& put) {
          const std::uint64_t begin = head_.size();
          std::uint64_t at = begin;
          for (const auto& [place, part] : arrays_) {
            const std::string offset = std::to_string(at - begin) + '"';
            std::copy(offset.begin(), offset.end(), head_.begin() + static_cast<std::ptrdiff_t>(place));
            at = put_array(ranks_, put, at, part, block_bytes_);
          }
          if (!ranks_.is_root())
            return;
          put(0, std::as_bytes(std::span(head_)));
          put(at, std::as_bytes(std::span(std::string_view("\n  </AppendedData>\n</VTKFile>\n"))));
        });
  }

 private:
  void add(std::string_view words, const PartOfArray& part)
  {
    constexpr std::size_t room = 21;  // for the digits of any number, and a quotation mark
    head_ += fmt::format("        {} format=\"appended\" offset=\"", words);
    arrays_.emplace_back(head_.size(), part);
    head_ += std::string(room, ' ');
  }
  void of_root(std::string_view words, std::span<const std::byte> bytes)
  {
    add(fmt::format("{} NumberOfTuples=\"1\"", words), {ranks_.is_root() ? bytes : std::span<const std::byte>(), 0, bytes.size()});
    head_ += "/>\n";
  }

  Communicator& ranks_;
  std::string_view kind_;
  std::uint64_t block_bytes_;
  std::string head_;
  std::vector<std::pair<std::size_t, PartOfArray>> arrays_;  // each with the position of its offset in the header
};

void check_columns(std::span<const Column> columns, std::size_t items, const fs::path& file)
{
  for (const Column& column : columns)
    if (column.components < 1 || column.values.size() != items * static_cast<std::size_t>(column.components))
      throw std::invalid_argument(fmt::format("{}: column \"{}\" has {} values, {} items of {} components were expected", file.string(),
                                              column.name, column.values.size(), items, column.components));
}

void check_slice(const Slice& slice, std::size_t items, const fs::path& file)
{
  if (slice.lead != 0 || !slice.is_whole(static_cast<std::int64_t>(items)))
    throw std::invalid_argument(fmt::format("{}: {} of {} items from {} on are no whole pieces of {}", file.string(), items, slice.of_all,
                                            slice.first, slice.piece));
}

/// The numbers from, from + step, ..., as many as there are items on this rank.  Index is the type of VTK for numbers of points in these
/// files.
std::vector<Index> numbers_from(std::int64_t from, std::size_t count, Index step = 1)
{
  std::vector<Index> all(count);
  for (std::size_t i = 0; i < count; ++i)
    all[i] = static_cast<Index>((from + static_cast<std::int64_t>(i)) * step);
  return all;
}

}  // namespace

void write_particles(Communicator& ranks, const fs::path& file, Real time, const Slice& slice, std::span<const Real> positions,
                     std::span<const std::int64_t> ids, std::span<const Column> columns, const std::string& made_by)
{
  const std::size_t n = ids.size();
  if (positions.size() != 3 * n)
    throw std::invalid_argument(fmt::format("{}: {} coordinates for {} particles", file.string(), positions.size(), n));
  check_slice(slice, n, file);
  check_columns(columns, n, file);
  const std::vector<Index> vertices = numbers_from(slice.first, n), ends = numbers_from(slice.first + 1, n);
  XmlFile xml(ranks, "PolyData", slice.piece);
  xml.origin(time, made_by);
  xml.line(4,
           fmt::format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">",
                       slice.of_all));
  xml.line(6, "<PointData>");
  xml.array(id_name, ids, 1, slice);
  xml.columns("PointData", columns, slice);
  xml.line(6, "<CellData>");
  xml.columns("CellData", {}, slice);
  xml.line(6, "<Points>");
  xml.array("Points", positions, 3, slice);
  xml.line(6, "</Points>");
  xml.line(6, "<Verts>");
  xml.array("connectivity", vertices, 1, slice);
  xml.array("offsets", ends, 1, slice);
  xml.line(6, "</Verts>");
  for (const std::string_view none_of_it : {"Lines", "Strips", "Polys"}) {
    xml.line(6, fmt::format("<{}>", none_of_it));
    xml.array<std::int64_t>("connectivity", std::span<const std::int64_t>(), 1, {});
    xml.array<std::int64_t>("offsets", std::span<const std::int64_t>(), 1, {});
    xml.line(6, fmt::format("</{}>", none_of_it));
  }
  xml.write(file);
}

void write_particles(const fs::path& file, Real time, std::span<const Real> positions, std::span<const std::int64_t> ids,
                     std::span<const Column> columns, const std::string& made_by)
{
  write_particles(one_rank(), file, time, {0, static_cast<std::int64_t>(ids.size())}, positions, ids, columns, made_by);
}

void write_mesh(Communicator& ranks, const fs::path& file, Real time, const MeshSlice& mesh, std::span<const Column> node_columns,
                std::span<const Column> cell_columns, const std::string& made_by)
{
  const auto corners_of_cell = static_cast<std::size_t>(mesh.dimension) + 1;
  const std::size_t n_nodes = mesh.positions.size() / 3, n_cells = mesh.corners.size() / corners_of_cell;
  check_slice(mesh.nodes, n_nodes, file);
  check_slice(mesh.cells, n_cells, file);
  check_columns(node_columns, n_nodes, file);
  check_columns(cell_columns, n_cells, file);
  const Index width = mesh.dimension + 1;
  const std::vector<Index> ends = numbers_from(mesh.cells.first + 1, n_cells, width);
  const std::vector<std::uint8_t> types(n_cells, mesh.dimension == 2 ? VTK_TRIANGLE : VTK_TETRA);
  XmlFile xml(ranks, "UnstructuredGrid", mesh.nodes.piece);
  xml.origin(time, made_by);
  xml.line(4, fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">", mesh.nodes.of_all, mesh.cells.of_all));
  xml.line(6, "<PointData>");
  xml.columns("PointData", node_columns, mesh.nodes);
  xml.line(6, "<CellData>");
  xml.columns("CellData", cell_columns, mesh.cells);
  xml.line(6, "<Points>");
  xml.array("Points", mesh.positions, 3, mesh.nodes);
  xml.line(6, "</Points>");
  xml.line(6, "<Cells>");
  xml.array("connectivity", mesh.corners, 1, {mesh.cells.first * width, mesh.cells.of_all * width, mesh.cells.piece * width});
  xml.array("offsets", ends, 1, mesh.cells);
  xml.array("types", types, 1, mesh.cells);
  xml.line(6, "</Cells>");
  xml.write(file);
}

template <int D>
void write_mesh(const fs::path& file, Real time, const Mesh<D>& mesh, std::span<const Column> node_columns,
                std::span<const Column> cell_columns, const std::string& made_by)
{
  MeshSlice whole{D, {0, mesh.n_nodes()}, {}, {0, mesh.n_cells()}, {}};
  for (const auto& x : mesh.nodes())
    for (int d = 0; d < 3; ++d)
      whole.positions.push_back(d < D ? x[std::min(d, D - 1)] : 0.0);
  for (const auto& cell : mesh.cells())
    whole.corners.insert(whole.corners.end(), cell.begin(), cell.end());
  write_mesh(one_rank(), file, time, whole, node_columns, cell_columns, made_by);
}

template void write_mesh<2>(const fs::path&, Real, const Mesh<2>&, std::span<const Column>, std::span<const Column>, const std::string&);
template void write_mesh<3>(const fs::path&, Real, const Mesh<3>&, std::span<const Column>, std::span<const Column>, const std::string&);

void PvdSeries::drop_from(Real time)
{
  std::erase_if(entries_, [&](const auto& entry) { return entry.first >= time; });
}

void PvdSeries::resume(Real time)
{
  entries_.clear();
  if (std::error_code unreadable; !fs::exists(file_, unreadable))
    return;
  for (const auto& [t, path] : read_pvd(file_))
    if (t <= time)
      entries_.emplace_back(t, path.lexically_proximate(file_.parent_path()).string());
  save();
}

void PvdSeries::append(Real time, const fs::path& file)
{
  drop_from(time);
  entries_.emplace_back(time, file.lexically_proximate(file_.parent_path()).string());
  save();
}

void PvdSeries::save() const
{
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\"";
  if (!made_by_.empty())
    text += fmt::format(" {}=\"{}\"", origin_name, escaped(made_by_));
  text += ">\n  <Collection>\n";
  for (const auto& [t, name] : entries_)
    text += fmt::format("    <DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", t, escaped(name));
  write_whole(file_, text + "  </Collection>\n</VTKFile>\n");
}

}  // namespace talus
