#pragma once
// The data of the HTML report of a run, which `talus report` inserts into the template that the build makes.
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/output/csv.hpp"
#include "io/page/page_block.hpp"

namespace talus {

/// The number of a block of the page.
using BlockId = std::size_t;

struct PageWarning {
  std::string text;
  std::optional<int> line = {};  ///< line in the scene's text, counted from one, if known
};

struct PageBody {
  std::string name, material, law;
};

struct PageField {
  std::string name, label, unit;
  Real low = 0, high = 0;  ///< smallest and largest finite value of all frames
};

/// Positions; x, y and, in 3-D, z are integers in units of 1/65534 of the range from low to high.
struct PagePlaces {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  std::vector<BlockId> axes;  ///< two or three blocks
};

struct PageFrame {
  Real time = 0;  ///< time of the frame [s]
  std::int64_t count = 0;
  PagePlaces x;
  BlockId ids = 0;
  std::optional<BlockId> body;                 ///< nothing if there is one body
  std::optional<BlockId> growth;               ///< by how many hundredths each particle is drawn larger than the radius; nothing if none is
  std::vector<std::optional<BlockId>> fields;  ///< one for each field; nothing if this frame does not have it
  /// Seven numbers for each rigid body: how far the middle of its box in the page has moved [m], and the quaternion x, y, z, w by which the
  /// body has turned about it; nothing if they are not known.
  std::optional<BlockId> rigid;
};

struct PageParticles {
  std::int64_t total = 0, shown = 0;  ///< numbers of particles of the largest frame
  Real radius = 1;                    ///< radius of a drawn particle, so that shown neighbours touch [m]
  std::vector<PageBody> bodies;
  std::vector<PageField> fields;  ///< the first one is shown first
  std::vector<PageFrame> frames;
  std::optional<std::array<Real, 2>> range;  ///< range of colours of the first field, from the scene
};

struct PageMesh {
  std::int64_t nodes = 0;
  PagePlaces x;
  BlockId outline = 0;           ///< pairs of nodes
  std::optional<BlockId> cells;  ///< pairs of nodes; nothing if there are too many
};

/// The rigid parts of a mesh made from terrain.
struct PageGround {
  std::int64_t nodes = 0;
  PagePlaces x;
  BlockId rigid = 0;   ///< 3-D: triples of nodes; 2-D: pairs
  BlockId layers = 0;  ///< pairs of nodes: boundaries of layers
};

/// A body that does not deform, where it is at the beginning.
struct PageRigid {
  std::string name;
  std::int64_t nodes = 0;
  PagePlaces x;
  BlockId triangles = 0;  ///< triples of nodes: they fill it in 2-D, in 3-D they are its surface
};

struct PageTable {
  std::vector<CsvColumn> columns;      ///< the first column is the time [s]
  std::int64_t rows = 0, thinned = 1;  ///< number of rows in the file; one of `thinned` rows is in the page
  BlockId values = 0;                  ///< column after column; NaN means no value
};

/// A number that the page shows, and how it was measured.
struct PageMetric {
  std::string group, name;
  Real value = 0;
  std::string unit, note;
};

struct Page {
  std::string title, name;
  int dimension = 2;
  Vec3 up = Vec3::UnitY();
  std::optional<Real> live;  ///< the page asks for updates at this interval [s]
  std::string summary;       ///< text of summary.json; empty while the run continues
  std::string scene_file, scene_text;
  std::vector<PageWarning> warnings;
  std::vector<std::string> notes;  ///< descriptions of what is not in the page
  std::optional<PageParticles> particles;
  std::optional<PageMesh> mesh;
  std::optional<PageGround> ground;
  std::vector<PageRigid> rigid;
  std::optional<PageTable> history, run_out;
  std::vector<PageMetric> metrics;
  std::vector<PageBlock> blocks;

  BlockId add(PageBlock block);
  /// The size of the blocks in the page [B].
  std::size_t block_bytes() const;
};

/// A table of columns of equal length with about `most` of their rows, evenly spread and including the last one.
PageTable table_of(const std::vector<CsvColumn>& columns, const std::vector<std::vector<Real>>& values, std::size_t most, Page& page);

/// The data of the page without the blocks, as JSON.
std::string to_json(const Page& page);

/// The template with the data inserted.  Throws EnvironmentError with its name if the template has no place for them.
std::string filled(const std::string& text, const std::filesystem::path& template_file, const Page& page);

}  // namespace talus
