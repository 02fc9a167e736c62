#include "io/mesh/gmsh_write.hpp"

#include <fmt/format.h>

#include <map>
#include <string>

#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

/// Writes the sections of a file, in text or binary form.
class MshSink {
 public:
  explicit MshSink(MshKind kind) : binary_(kind == MshKind::binary) {}
  std::string take() { return std::move(bytes_); }

  void text(std::string_view text) { bytes_ += text; }
  void integer(int value) { put(static_cast<std::int32_t>(value)); }
  void size(std::size_t value) { put(static_cast<std::uint64_t>(value)); }
  void real(Real value) { put(value); }
  void end_line()
  {
    if (!binary_)
      bytes_ += '\n';
  }
  void end_section(std::string_view closing) { bytes_ += fmt::format("{}{}\n", binary_ ? "\n" : "", closing); }
  void header()
  {
    bytes_ += fmt::format("$MeshFormat\n4.1 {} 8\n", binary_ ? 1 : 0);
    if (!binary_)
      return text("$EndMeshFormat\n");
    integer(1);
    end_section("$EndMeshFormat");
  }

 private:
  template <class T>
  void put(T value)
  {
    if (binary_)
      bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
    else
      fmt::format_to(std::back_inserter(bytes_), "{} ", value);
  }

  std::string bytes_;
  bool binary_;
};

/// Nodes of the elements of one dimension, element after element, by the combination of groups: in 4.1 groups consist of entities, and
/// entities of elements.
using ByGroups = std::map<std::vector<std::int32_t>, std::vector<Index>>;

template <int D>
class MshWriter {
 public:
  MshWriter(const Mesh<D>& mesh, MshKind kind) : mesh_(mesh), sink_(kind)
  {
    gather_cells();
    gather_facets();
    gather_nodes();
  }

  std::string write()
  {
    sink_.header();
    write_names();
    write_entities();
    write_nodes();
    write_elements();
    return sink_.take();
  }

 private:
  std::int32_t new_group(int dimension, const std::string& name)
  {
    names_.emplace_back(dimension, name);
    return static_cast<std::int32_t>(names_.size());
  }

  template <std::size_t N>
  static void append(std::vector<Index>& elements, const std::array<Index, N>& nodes)
  {
    elements.insert(elements.end(), nodes.begin(), nodes.end());
  }

  void gather_cells()
  {
    std::vector<std::vector<std::int32_t>> groups(static_cast<std::size_t>(mesh_.n_cells()));
    for (const std::string& name : mesh_.cell_set_names()) {
      const std::int32_t group = new_group(D, name);
      const auto cells = mesh_.cell_set(name);
      for (const Index c : *cells)
        groups[c].push_back(group);
    }
    for (Index c = 0; c < mesh_.n_cells(); ++c)
      append(elements_[D][groups[c]], mesh_.cell(c));
  }

  void gather_facets()
  {
    std::map<std::pair<Index, Index>, std::vector<std::int32_t>> groups;
    for (const std::string& name : mesh_.facet_set_names()) {
      const std::int32_t group = new_group(D - 1, name);
      const auto facets = mesh_.facet_set(name);
      for (const Facet f : *facets)
        groups[{f.cell, f.local}].push_back(group);
    }
    for (const auto& [facet, in_groups] : groups)
      append(elements_[D - 1][in_groups], mesh_.nodes_of({facet.first, facet.second}));
  }

  void gather_nodes()
  {
    std::map<Index, std::vector<std::int32_t>> groups;
    for (const std::string& name : mesh_.node_set_names()) {
      if (mesh_.facet_set(name) || mesh_.cell_set(name))
        continue;
      const std::int32_t group = new_group(0, name);
      const auto nodes = mesh_.node_set(name);
      for (const Index n : *nodes)
        groups[n].push_back(group);
    }
    for (const auto& [node, in_groups] : groups)
      elements_[0][in_groups].push_back(node);
  }

  void write_names()
  {
    if (names_.empty())
      return;
    sink_.text(fmt::format("$PhysicalNames\n{}\n", names_.size()));
    for (std::size_t i = 0; i < names_.size(); ++i)
      sink_.text(fmt::format("{} {} \"{}\"\n", names_[i].first, i + 1, names_[i].second));
    sink_.text("$EndPhysicalNames\n");
  }

  void write_entities()
  {
    sink_.text("$Entities\n");
    for (const ByGroups& entities : elements_)
      sink_.size(entities.size());
    sink_.end_line();
    for (int d = 0; d < 4; ++d) {
      int tag = 0;
      for (const auto& [groups, nodes] : elements_[d]) {
        sink_.integer(++tag);
        write_bounds(d, nodes);
        sink_.size(groups.size());
        for (const std::int32_t group : groups)
          sink_.integer(group);
        if (d > 0)
          sink_.size(0);  // no bounding entities
        sink_.end_line();
      }
    }
    sink_.end_section("$EndEntities");
  }

  Vec3 place_of(Index node) const
  {
    Vec3 x = Vec3::Zero();
    x.template head<D>() = mesh_.node(node);
    return x;
  }

  /// Writes the position of a point, or the bounding box of any other entity.
  void write_bounds(int dimension, const std::vector<Index>& nodes)
  {
    Vec3 low = place_of(nodes[0]), high = low;
    for (const Index n : nodes) {
      low = low.cwiseMin(place_of(n));
      high = high.cwiseMax(place_of(n));
    }
    for (const Real x : low)
      sink_.real(x);
    for (int i = 0; dimension > 0 && i < 3; ++i)
      sink_.real(high[i]);
  }

  void write_nodes()
  {
    const auto n_nodes = static_cast<std::size_t>(mesh_.n_nodes());
    sink_.text("$Nodes\n");
    for (const std::size_t value : {std::size_t{1}, n_nodes, std::size_t{1}, n_nodes})
      sink_.size(value);
    sink_.end_line();
    for (const int value : {D, 1, 0})  // all on the first entity of cells, without parameters
      sink_.integer(value);
    sink_.size(n_nodes);
    sink_.end_line();
    for (std::size_t n = 1; n <= n_nodes; ++n) {
      sink_.size(n);
      sink_.end_line();
    }
    for (Index n = 0; n < mesh_.n_nodes(); ++n) {
      for (const Real x : place_of(n))
        sink_.real(x);
      sink_.end_line();
    }
    sink_.end_section("$EndNodes");
  }

  void write_elements()
  {
    constexpr std::array<int, 4> types{15, 1, 2, 4};
    std::size_t n_blocks = 0, n_elements = 0;
    for (std::size_t d = 0; d < 4; ++d)
      for (const auto& [groups, nodes] : elements_[d]) {
        ++n_blocks;
        n_elements += nodes.size() / (d + 1);
      }
    sink_.text("$Elements\n");
    for (const std::size_t value : {n_blocks, n_elements, std::size_t{1}, n_elements})
      sink_.size(value);
    sink_.end_line();
    std::size_t tag = 0;
    for (int d = 0; d < 4; ++d) {
      const auto per_element = static_cast<std::size_t>(d) + 1;
      int entity = 0;
      for (const auto& [groups, nodes] : elements_[d]) {
        for (const int value : {d, ++entity, types[d]})
          sink_.integer(value);
        sink_.size(nodes.size() / per_element);
        sink_.end_line();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          if (i % per_element == 0)
            sink_.size(++tag);
          sink_.size(static_cast<std::size_t>(nodes[i]) + 1);
          if ((i + 1) % per_element == 0)
            sink_.end_line();
        }
      }
    }
    sink_.end_section("$EndElements");
  }

  const Mesh<D>& mesh_;
  MshSink sink_;
  std::vector<std::pair<int, std::string>> names_;  ///< dimension and name of the groups, which are numbered from 1 over all dimensions
  std::array<ByGroups, 4> elements_;                ///< entry for each dimension
};

}  // namespace

template <int D>
void write_msh(const std::filesystem::path& file, const Mesh<D>& mesh, MshKind kind)
{
  write_whole(file, MshWriter<D>(mesh, kind).write());
}

template void write_msh<2>(const std::filesystem::path&, const Mesh<2>&, MshKind);
template void write_msh<3>(const std::filesystem::path&, const Mesh<3>&, MshKind);

}  // namespace talus
