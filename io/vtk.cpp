// The only file of this library that knows VTK.  Arrays are lent to VTK, not copied, wherever the layouts agree.
#include "io/vtk.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkIntArray.h>
#include <vtkLogger.h>
#include <vtkLongArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkStringOutputWindow.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <numeric>
#include <stdexcept>

#include "core/error.hpp"
#include "io/whole_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view id_name = "id", origin_name = "MadeBy";

/// An array that shows `values` to VTK.  VTK's interface is not const; writers only read, and `save` = 1 keeps the memory ours.
template <class Array, class T>
vtkSmartPointer<Array> lend(std::span<const T> values, int components, const char* name)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetArray(const_cast<T*>(values.data()), static_cast<vtkIdType>(values.size()), 1);
  return array;
}

void add_columns(vtkFieldData* data, std::span<const Column> columns, std::size_t items, const fs::path& file)
{
  for (const Column& column : columns) {
    if (column.components < 1 || column.values.size() != items * static_cast<std::size_t>(column.components))
      throw std::invalid_argument(fmt::format("{}: column \"{}\" has {} values, {} items of {} components were expected", file.string(),
                                              column.name, column.values.size(), items, column.components));
    const auto array = lend<vtkFloatArray>(std::span<const float>(column.values), column.components, column.name.c_str());
    if (!column.unit.empty())
      array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), column.unit.c_str());
    data->AddArray(array);
  }
}

void add_origin(vtkDataObject* object, Real time, const std::string& made_by)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName("TimeValue");  // the name ParaView looks for
  array->InsertNextValue(time);
  object->GetFieldData()->AddArray(array);
  if (made_by.empty())
    return;
  vtkNew<vtkStringArray> text;
  text->SetName(origin_name.data());
  text->InsertNextValue(made_by);
  object->GetFieldData()->AddArray(text);
}

/// VTK prints errors and goes on; this keeps the first one instead.
void keep_message(vtkObject*, unsigned long, void* kept, void* message)
{
  auto& text = *static_cast<std::string*>(kept);
  if (text.empty() && message != nullptr)
    text = static_cast<const char*>(message);
}

template <class Writer>
void write(const fs::path& file, vtkDataObject* object)
{
  write_whole(file, [&](const fs::path& temporary) {
    std::string message;
    vtkNew<vtkCallbackCommand> observer;
    observer->SetCallback(keep_message);
    observer->SetClientData(&message);
    vtkNew<Writer> writer;
    writer->AddObserver(vtkCommand::ErrorEvent, observer);
    writer->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, observer);
    writer->SetFileName(temporary.c_str());
    writer->SetInputDataObject(object);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    writer->SetHeaderTypeToUInt64();
    writer->SetCompressorTypeToLZ4();
    if (writer->Write() != 1 || writer->GetErrorCode() != 0 || !message.empty())
      throw EnvironmentError(fmt::format("cannot write {}: {}", file.string(), message.empty() ? "the disk may be full" : message));
  });
}

vtkSmartPointer<vtkCellArray> cell_array(vtkSmartPointer<vtkIntArray> nodes, vtkIdType cells, int nodes_per_cell)
{
  vtkNew<vtkIntArray> offsets;
  offsets->SetNumberOfValues(cells + 1);
  for (vtkIdType c = 0; c <= cells; ++c)
    offsets->SetValue(c, static_cast<int>(c * nodes_per_cell));
  auto array = vtkSmartPointer<vtkCellArray>::New();
  array->SetData(offsets, nodes);
  return array;
}

/// While this lives, VTK's complaints come here instead of to the screen: observers do not reach the parsers inside its readers.
class VtkComplaints {
 public:
  VtkComplaints() : window_(vtkOutputWindow::GetInstance()), log_(vtkLogger::GetCurrentVerbosityCutoff())
  {
    vtkOutputWindow::SetInstance(heard_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~VtkComplaints()
  {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(log_);
  }
  VtkComplaints(const VtkComplaints&) = delete;
  VtkComplaints& operator=(const VtkComplaints&) = delete;

  /// The first complaint, without the place in VTK's sources; empty for none.
  std::string first() const
  {
    const std::string all = heard_->GetOutput();
    const auto object = all.find("): ");  // "ERROR: In file.cxx, line 1\nvtkClass (0x1234): what is wrong"
    const auto begin = object == std::string::npos ? 0 : object + 3;
    return all.substr(begin, all.find('\n', begin) - begin);
  }

 private:
  vtkSmartPointer<vtkOutputWindow> window_;
  vtkLogger::Verbosity log_;
  vtkNew<vtkStringOutputWindow> heard_;
};

/// What stands in front of an array in the appended data of a file with header_type="UInt64" and a compressor.
struct BlockHeader {
  std::uint64_t blocks, size, last_size;  ///< number of blocks, bytes of each when unpacked, bytes of the last if it is not whole
};

/// Whether the blocks of the array at `begin` lie in the file.
bool blocks_fit(std::string_view text, std::size_t begin)
{
  BlockHeader header{};
  if (begin > text.size() || text.size() - begin < sizeof header)
    return false;
  std::memcpy(&header, text.data() + begin, sizeof header);
  std::uint64_t room = text.size() - begin - sizeof header;
  if (header.blocks == 0)
    return header.last_size == 0;
  if (header.size == 0 || header.last_size > header.size || header.blocks > room / sizeof(std::uint64_t))
    return false;
  const char* next = text.data() + begin + sizeof header;
  room -= header.blocks * sizeof(std::uint64_t);
  for (std::uint64_t block = 0; block < header.blocks; ++block, next += sizeof(std::uint64_t)) {
    std::uint64_t packed = 0;
    std::memcpy(&packed, next, sizeof packed);
    if (packed > room)
      return false;
    room -= packed;
  }
  return true;
}

/// Throws unless the file is laid out as `write` does it and is long enough: VTK's readers trust the lengths before the numbers, divide by
/// them, and take the numbers as they come where a word of the first line is damaged.
void check_layout(const fs::path& file)
{
  const std::string text = read_whole(file);
  const std::string_view all = text;
  const std::size_t data = all.find("<AppendedData encoding=\"raw\">");
  const std::size_t begin = data == std::string_view::npos ? data : all.find('_', data);
  const std::string_view first_line = all.substr(0, all.find('>', all.find("<VTKFile")));
  bool fits = begin != std::string_view::npos;
  for (const std::string_view word : {"byte_order=\"LittleEndian\"", "header_type=\"UInt64\"", "compressor=\"vtkLZ4DataCompressor\""})
    fits = fits && first_line.find(word) != std::string_view::npos;
  constexpr std::string_view key = "offset=\"";
  for (std::size_t at = all.find(key); fits && at < data; at = all.find(key, at + 1)) {
    std::size_t offset = 0;
    const char* number = text.data() + at + key.size();
    fits = std::from_chars(number, text.data() + data, offset).ec == std::errc{} && offset < text.size() &&
           blocks_fit(all, begin + 1 + offset);
  }
  if (!fits)
    throw EnvironmentError(fmt::format("cannot read {}: it is damaged, or not written by talus", file.string()));
}

/// The file in the reader.  VTK's readers go on after errors; this one stops.
template <class Reader>
void read_file(Reader& reader, const fs::path& file)
{
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored))
    throw EnvironmentError(fmt::format("cannot read {}: there is no such file", file.string()));
  check_layout(file);
  const VtkComplaints complaints;
  reader.SetFileName(file.c_str());
  try {
    reader.Update();
  } catch (const std::exception&) {  // such as std::bad_alloc, for a length that is nonsense
    throw EnvironmentError(fmt::format("cannot read {}: it is damaged, or larger than the memory", file.string()));
  }
  if (const std::string complaint = complaints.first(); !complaint.empty() || reader.GetErrorCode() != 0)
    throw EnvironmentError(fmt::format("cannot read {}: it is damaged{}{}", file.string(), complaint.empty() ? "" : ": ", complaint));
}

StoredField stored(vtkDataArray& array, std::string name)
{
  StoredField field{std::move(name), array.GetNumberOfComponents(), {}};
  const auto components = static_cast<std::size_t>(field.components);
  field.values.resize(components * static_cast<std::size_t>(array.GetNumberOfTuples()));
  for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i)
    array.GetTuple(i, field.values.data() + components * static_cast<std::size_t>(i));
  if (const char* unit = array.GetInformation()->Get(vtkDataArray::UNITS_LABEL()))
    field.unit = unit;
  return field;
}

/// All arrays but the ids, and the points if there are any, as "position".
std::vector<StoredField> stored_fields(vtkFieldData& data, vtkPoints* points)
{
  std::vector<StoredField> fields;
  if (points != nullptr) {
    fields.push_back(stored(*points->GetData(), "position"));
    fields.back().unit = "m";
  }
  for (int i = 0; i < data.GetNumberOfArrays(); ++i)
    if (vtkDataArray* array = data.GetArray(i); array != nullptr && array->GetName() != nullptr && id_name != array->GetName())
      fields.push_back(stored(*array, array->GetName()));
  return fields;
}

std::string escaped(const std::string& text)
{
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return out;
}

}  // namespace

void write_particles(const fs::path& file, Real time, std::span<const Real> positions, std::span<const std::int64_t> ids,
                     std::span<const Column> columns, const std::string& made_by)
{
  const std::size_t n = ids.size();
  if (positions.size() != 3 * n)
    throw std::invalid_argument(fmt::format("{}: {} coordinates for {} particles", file.string(), positions.size(), n));
  vtkNew<vtkPoints> points;
  points->SetData(lend<vtkDoubleArray>(positions, 3, "Points"));
  auto vertices = vtkSmartPointer<vtkIntArray>::New();
  vertices->SetNumberOfValues(static_cast<vtkIdType>(n));
  std::iota(vertices->GetPointer(0), vertices->GetPointer(0) + n, 0);

  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(points);
  cloud->SetVerts(cell_array(vertices, static_cast<vtkIdType>(n), 1));
  static_assert(std::is_same_v<std::int64_t, long>);
  cloud->GetPointData()->AddArray(lend<vtkLongArray>(ids, 1, id_name.data()));
  add_columns(cloud->GetPointData(), columns, n, file);
  add_origin(cloud, time, made_by);
  write<vtkXMLPolyDataWriter>(file, cloud);
}

template <int D>
void write_mesh(const fs::path& file, Real time, const Mesh<D>& mesh, std::span<const Column> node_columns,
                std::span<const Column> cell_columns, const std::string& made_by)
{
  const auto nodes = mesh.nodes();
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(mesh.n_nodes());
  double* place = coordinates->GetPointer(0);
  for (const auto& x : nodes)
    for (int d = 0; d < 3; ++d)
      *place++ = d < D ? x[std::min(d, D - 1)] : 0.0;
  vtkNew<vtkPoints> points;
  points->SetData(coordinates);

  auto corners = vtkSmartPointer<vtkIntArray>::New();
  corners->SetNumberOfValues(mesh.n_cells() * vtkIdType{D + 1});
  int* corner = corners->GetPointer(0);
  for (const auto& cell : mesh.cells())
    corner = std::copy(cell.begin(), cell.end(), corner);

  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  grid->SetCells(D == 2 ? VTK_TRIANGLE : VTK_TETRA, cell_array(corners, mesh.n_cells(), D + 1));
  add_columns(grid->GetPointData(), node_columns, nodes.size(), file);
  add_columns(grid->GetCellData(), cell_columns, mesh.cells().size(), file);
  add_origin(grid, time, made_by);
  write<vtkXMLUnstructuredGridWriter>(file, grid);
}

template void write_mesh<2>(const fs::path&, Real, const Mesh<2>&, std::span<const Column>, std::span<const Column>, const std::string&);
template void write_mesh<3>(const fs::path&, Real, const Mesh<3>&, std::span<const Column>, std::span<const Column>, const std::string&);

StoredParticles read_particles(const fs::path& file)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  read_file(*reader, file);
  vtkPolyData* cloud = reader->GetOutput();
  vtkDataArray* ids = cloud->GetPointData()->GetArray(id_name.data());
  const int type = ids == nullptr ? VTK_VOID : ids->GetDataType();
  if ((type != VTK_LONG && type != VTK_LONG_LONG && type != VTK_ID_TYPE) || ids->GetNumberOfComponents() != 1)
    throw EnvironmentError(fmt::format("{}: its particles have no field \"{}\" of whole numbers", file.string(), id_name));
  static_assert(sizeof(long) == sizeof(std::int64_t) && sizeof(vtkIdType) == sizeof(std::int64_t));
  StoredParticles particles{{}, stored_fields(*cloud->GetPointData(), cloud->GetPoints()), {}};
  if (auto* text = vtkStringArray::SafeDownCast(cloud->GetFieldData()->GetAbstractArray(origin_name.data()));
      text && text->GetNumberOfValues() > 0)
    particles.made_by = text->GetValue(0);
  particles.ids.resize(static_cast<std::size_t>(ids->GetNumberOfTuples()));
  if (!particles.ids.empty())
    std::memcpy(particles.ids.data(), ids->GetVoidPointer(0), particles.ids.size() * sizeof(std::int64_t));
  return particles;
}

StoredMeshFields read_mesh_fields(const fs::path& file)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  read_file(*reader, file);
  vtkUnstructuredGrid* grid = reader->GetOutput();
  return {stored_fields(*grid->GetPointData(), grid->GetPoints()), stored_fields(*grid->GetCellData(), nullptr)};
}

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

std::vector<std::pair<Real, fs::path>> read_pvd(const fs::path& file)
{
  const std::string text = read_whole(file);
  const VtkComplaints silenced;
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromString(text.c_str()));
  vtkXMLDataElement* list = root ? root->FindNestedElementWithName("Collection") : nullptr;
  if (list == nullptr)
    throw EnvironmentError(fmt::format("{} is not a list of VTK files (.pvd)", file.string()));
  std::vector<std::pair<Real, fs::path>> entries;
  for (int i = 0; i < list->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* entry = list->GetNestedElement(i);
    double time = 0;
    const char* name = entry->GetAttribute("file");
    if (name == nullptr || entry->GetScalarAttribute("timestep", time) == 0)
      throw EnvironmentError(fmt::format("{}: entry {} has no file or no timestep", file.string(), i + 1));
    entries.emplace_back(time, file.parent_path() / name);
  }
  return entries;
}

}  // namespace talus
