#include "io/mesh/gmsh_read.hpp"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <stdexcept>

#include "io/mesh/msh_assembler.hpp"
#include "io/mesh/msh_source.hpp"

namespace talus {

namespace {

constexpr std::int64_t highest_tag = std::numeric_limits<std::int64_t>::max() - 1;  // its successor must not overflow

/// One pass over the sections of a file.  The formats are described in the reference manual of gmsh, "MSH file format".
template <int D>
class MshReader {
 public:
  MshReader(const std::filesystem::path& file, const SourceLocation& asked_by) : source_(file, asked_by) {}

  MeshData<D> read()
  {
    while (const auto section = source_.next_section())
      read_section(*section);
    if (!elements_read_)
      source_.fail_file(version_ == 0 ? "the file has no $MeshFormat section: is it a .msh file?" : "the file has no $Elements section");
    try {
      return assembler_.finish(version_ == 2);
    } catch (const std::invalid_argument& complaint) {
      source_.fail_file(complaint.what());
    }
  }

 private:
  /// Calls f(); errors get the position that was read last.
  template <class F>
  auto located(F&& f)
  {
    try {
      return f();
    } catch (const std::invalid_argument& complaint) {
      source_.fail(complaint.what());
    }
  }

  void read_section(const std::string& section)
  {
    if (version_ == 0 && section != "MeshFormat" && section != "Comments")
      source_.fail("the file does not begin with $MeshFormat: is it a .msh file of format 2.2 or 4.1?");
    if (section == "MeshFormat")
      read_format();
    else if (section == "PhysicalNames")
      read_names();
    else if (section == "Entities" && version_ == 4)
      read_entities();
    else if (section == "PartitionedEntities")
      source_.fail("the mesh is partitioned: save it in one part (in gmsh: Delete Partitions)");
    else if (section == "Nodes")
      read_nodes();
    else if (section == "Elements")
      read_elements();
    else
      return source_.skip_section(section);
    source_.close_section(section);
  }

  void read_format()
  {
    if (version_ != 0)
      source_.fail("a second $MeshFormat section");
    const Real version = source_.text_real("the version of the format");
    if (version != 4.1 && !(version >= 2 && version < 3))
      source_.fail(fmt::format("format {} is not supported, only 2.2 and 4.1 (in gmsh: Mesh.MshFileVersion = 4.1)", version));
    const std::int64_t kind = source_.text_integer("0 for ascii or 1 for binary");
    if (kind != 0 && kind != 1)
      source_.fail(fmt::format("the file type is {}, neither 0 (ascii) nor 1 (binary)", kind));
    const std::int64_t size = source_.text_integer("the size of a number in bytes");
    if (size != 8)
      source_.fail(fmt::format("numbers of {} bytes are not supported, only 8", size));
    version_ = version == 4.1 ? 4 : 2;
    if (kind == 0)
      return;
    source_.end_line("the format");
    source_.become_binary(false);
    const std::int64_t one = source_.integer("the number one");
    if (one != 1 && one != 0x01000000)
      source_.fail(fmt::format("the byte order cannot be told: expected the number one, found {}", one));
    source_.become_binary(one != 1);
  }

  void read_names()
  {
    const std::int64_t n = source_.text_integer("the number of names");
    source_.check_count(n, "the number of names", 6, 6);
    for (std::int64_t i = 0; i < n; ++i) {
      const std::int64_t dimension = source_.text_integer("the dimension of a group");
      if (dimension < 0 || dimension > 3)
        source_.fail(fmt::format("a group of dimension {}, outside [0, 3]", dimension));
      const std::int64_t tag = source_.text_integer("the tag of a group");
      std::string name = source_.text_quoted("the name of a group");
      located([&] { assembler_.name_group(static_cast<int>(dimension), tag, std::move(name)); });
    }
  }

  /// Reads the geometric entities of format 4.1, of which only physical groups are used.
  void read_entities()
  {
    if (have_entities_)
      source_.fail("a second $Entities section");
    have_entities_ = true;
    constexpr std::array<std::int64_t, 4> text{10, 18, 18, 18}, binary{36, 68, 68, 68};
    std::array<std::int64_t, 4> counts;
    for (std::size_t d = 0; d < 4; ++d)
      counts[d] = source_.count("the number of entities", text[d], binary[d]);
    for (int d = 0; d < 4; ++d)
      for (std::int64_t i = 0; i < counts[d]; ++i)
        read_entity(d);
  }

  void read_entity(int dimension)
  {
    const std::int64_t tag = source_.integer("the tag of an entity");
    const auto [entity, is_new] = groups_of_.try_emplace({dimension, tag});
    if (!is_new)
      source_.fail(fmt::format("entity {} of dimension {} occurs twice", tag, dimension));
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i)
      source_.real("the bounding box of an entity");
    const std::int64_t n = source_.count("the number of groups of an entity", 2, 4);
    for (std::int64_t i = 0; i < n; ++i)
      entity->second.push_back(std::abs(source_.integer("the tag of a group")));  // the sign is the orientation
    if (dimension == 0)
      return;
    const std::int64_t bounding = source_.count("the number of bounding entities", 2, 4);
    for (std::int64_t i = 0; i < bounding; ++i)
      source_.integer("the tag of a bounding entity");
  }

  void read_nodes()
  {
    if (nodes_read_)
      source_.fail("a second $Nodes section");
    nodes_read_ = true;
    if (version_ == 4)
      read_nodes_4();
    else
      read_nodes_2();
    located([&] { assembler_.close_nodes(); });
  }

  void read_nodes_2()
  {
    const std::int64_t n = source_.text_integer("the number of nodes");
    if (source_.binary())
      source_.end_line("the number of nodes");
    source_.check_count(n, "the number of nodes", 8, 28);
    for (std::int64_t i = 0; i < n; ++i) {
      const std::int64_t tag = source_.integer("the tag of a node");
      assembler_.add_node(tag, read_place());
    }
  }

  Vec3 read_place()
  {
    const Real x = source_.real("the x coordinate of a node");
    const Real y = source_.real("the y coordinate of a node");
    const Real z = source_.real("the z coordinate of a node");
    return {x, y, z};
  }

  /// The beginning of $Nodes and $Elements in 4.1: numbers of blocks and items, range of tags.
  struct Contents {
    std::int64_t blocks, items, low, high;
  };
  Contents read_contents(std::string_view what, std::int64_t bytes_in_text, std::int64_t bytes_in_binary)
  {
    Contents contents;
    contents.blocks = source_.count("the number of blocks", 8, 20);
    contents.items = source_.count(what, bytes_in_text, bytes_in_binary);
    contents.low = source_.tag("the lowest tag", 0, highest_tag);
    contents.high = source_.tag("the highest tag", contents.low, highest_tag);
    return contents;
  }
  void check_total(std::int64_t seen, std::int64_t declared, std::string_view what)
  {
    if (seen != declared)
      source_.fail(fmt::format("{} {} announced, {} found", declared, what, seen));
  }

  void read_nodes_4()
  {
    const Contents contents = read_contents("the number of nodes", 8, 32);
    std::int64_t seen = 0;
    std::vector<std::int64_t> tags;
    for (std::int64_t block = 0; block < contents.blocks; ++block) {
      const std::int64_t dimension = read_dimension();
      source_.integer("the tag of an entity");
      const std::int64_t parametric = source_.integer("whether the nodes have parameters");
      if (parametric != 0 && parametric != 1)
        source_.fail(fmt::format("the parametric flag is {}, neither 0 nor 1", parametric));
      const std::int64_t n = source_.count("the number of nodes of a block", 8, 32);
      seen += n;
      if (seen > contents.items)
        check_total(seen, contents.items, "nodes");
      tags.clear();
      for (std::int64_t i = 0; i < n; ++i)
        tags.push_back(source_.tag("the tag of a node", contents.low, contents.high));
      for (const std::int64_t tag : tags) {
        assembler_.add_node(tag, read_place());
        for (std::int64_t p = 0; p < parametric * dimension; ++p)
          source_.real("a parameter of a node");
      }
    }
    check_total(seen, contents.items, "nodes");
  }

  std::int64_t read_dimension()
  {
    const std::int64_t dimension = source_.integer("the dimension of an entity");
    if (dimension < 0 || dimension > 3)
      source_.fail(fmt::format("an entity of dimension {}, outside [0, 3]", dimension));
    return dimension;
  }

  void read_elements()
  {
    if (!nodes_read_)
      source_.fail("$Elements stands before $Nodes");
    if (elements_read_)
      source_.fail("a second $Elements section");
    elements_read_ = true;
    if (version_ == 4)
      read_elements_4();
    else
      read_elements_2();
  }

  void read_elements_2()
  {
    const std::int64_t n = source_.text_integer("the number of elements");
    if (source_.binary())
      source_.end_line("the number of elements");
    source_.check_count(n, "the number of elements", 8, 8);
    for (std::int64_t seen = 0; seen < n;) {
      // In text every element has type and number of tags, in binary a block of elements does.
      std::int64_t tag = 0, in_block = 1;
      if (!source_.binary())
        tag = source_.integer("the tag of an element");
      const int dimension = read_type();
      if (source_.binary())
        in_block = source_.integer("the number of elements of a block");
      if (in_block < 1 || in_block > n - seen)
        source_.fail(fmt::format("a block of {} elements where {} of {} are left", in_block, n - seen, n));
      const std::int64_t n_tags = source_.integer("the number of tags of an element");
      source_.check_count(n_tags, "the number of tags of an element", 2, 4);
      for (std::int64_t i = 0; i < in_block; ++i) {
        if (source_.binary())
          tag = source_.integer("the tag of an element");
        read_element_2(tag, dimension, n_tags);
      }
      seen += in_block;
    }
  }

  void read_element_2(std::int64_t tag, int dimension, std::int64_t n_tags)
  {
    std::int64_t group = 0;  // the first tag; zero means no group
    for (std::int64_t i = 0; i < n_tags; ++i) {
      const std::int64_t value = source_.integer("a tag of an element");
      if (i == 0)
        group = std::abs(value);
    }
    std::array<std::int64_t, 4> nodes{};
    for (int a = 0; a <= dimension; ++a)
      nodes[a] = source_.integer("a node of an element");
    const std::span<const std::int64_t> groups(&group, group == 0 ? 0 : 1);
    located([&] { assembler_.add_element(tag, dimension, groups, nodes); });
  }

  void read_elements_4()
  {
    const Contents contents = read_contents("the number of elements", 4, 16);
    std::int64_t seen = 0;
    for (std::int64_t block = 0; block < contents.blocks; ++block) {
      const std::int64_t entity_dimension = read_dimension();
      const std::int64_t entity = source_.integer("the tag of an entity");
      const auto found = groups_of_.find({static_cast<int>(entity_dimension), entity});
      if (have_entities_ && found == groups_of_.end())
        source_.fail(fmt::format("$Entities has no entity {} of dimension {}", entity, entity_dimension));
      const std::span<const std::int64_t> groups = found == groups_of_.end() ? std::span<const std::int64_t>{} : found->second;
      const int dimension = read_type();
      if (dimension != entity_dimension)
        source_.fail(fmt::format("elements of dimension {} on an entity of dimension {}", dimension, entity_dimension));
      const std::int64_t n = source_.count("the number of elements of a block", 4, 8 * (dimension + 2));
      seen += n;
      if (seen > contents.items)
        check_total(seen, contents.items, "elements");
      for (std::int64_t i = 0; i < n; ++i) {
        const std::int64_t tag = source_.tag("the tag of an element", contents.low, contents.high);
        std::array<std::int64_t, 4> nodes{};
        for (int a = 0; a <= dimension; ++a)
          nodes[a] = source_.tag("a node of an element", 0, highest_tag);
        located([&] { assembler_.add_element(tag, dimension, groups, nodes); });
      }
    }
    check_total(seen, contents.items, "elements");
  }

  int read_type()
  {
    const std::int64_t type = source_.integer("the type of an element");
    return located([&] { return dimension_of_element(type, D); });
  }

  MshSource source_;
  MshAssembler<D> assembler_;
  int version_ = 0;  ///< version of the format, 2 or 4
  bool have_entities_ = false, nodes_read_ = false, elements_read_ = false;
  std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>> groups_of_;  ///< groups of each entity (dimension, tag)
};

}  // namespace

template <int D>
MeshData<D> read_msh(const std::filesystem::path& file, const SourceLocation& asked_by)
{
  return MshReader<D>(file, asked_by).read();
}

template MeshData<2> read_msh<2>(const std::filesystem::path&, const SourceLocation&);
template MeshData<3> read_msh<3>(const std::filesystem::path&, const SourceLocation&);

}  // namespace talus
