#pragma once
// A run as one page for the browser: what `talus report` puts into the template that the build makes.
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/output/csv.hpp"
#include "io/page/page_block.hpp"

namespace talus {

/// Number of a block of the page.
using BlockId = std::size_t;

struct PageWarning {
  std::string text;
  std::optional<int> line = {};  ///< of the scene's text, from one, where it is known
};

struct PageBody {
  std::string name, material, law;
};

struct PageField {
  std::string name, label, unit;
  Real low = 0, high = 0;  ///< of all frames, finite values
};

/// Numbers of x, y and, in 3-D, z are counted in 65534ths from low to high.
struct PagePlaces {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  std::vector<BlockId> axes;  ///< two or three
};

struct PageFrame {
  Real time = 0;  ///< s
  std::int64_t count = 0;
  PagePlaces x;
  BlockId ids = 0;
  std::optional<BlockId> body;                 ///< nothing where there is one body
  std::optional<BlockId> growth;               ///< by how many hundredths each is drawn larger than the radius; nothing where none is
  std::vector<std::optional<BlockId>> fields;  ///< one for each field; nothing where this frame does not have it
};

struct PageParticles {
  std::int64_t total = 0, shown = 0;  ///< of the largest frame
  Real radius = 1;                    ///< of a particle as drawn, so that those that are shown touch [m]
  std::vector<PageBody> bodies;
  std::vector<PageField> fields;  ///< the first is shown first
  std::vector<PageFrame> frames;
  std::optional<std::array<Real, 2>> range;  ///< of the first field, as the scene wants it drawn
};

struct PageMesh {
  std::int64_t nodes = 0;
  PagePlaces x;
  BlockId outline = 0;           ///< pairs of nodes
  std::optional<BlockId> cells;  ///< pairs of nodes, unless there are too many
};

/// What is rigid in a mesh of terrain.
struct PageGround {
  std::int64_t nodes = 0;
  PagePlaces x;
  BlockId rigid = 0;   ///< 3-D: triples of nodes; 2-D: pairs
  BlockId layers = 0;  ///< pairs of nodes: where layers end
};

struct PageTable {
  std::vector<CsvColumn> columns;      ///< the first is the time [s]
  std::int64_t rows = 0, thinned = 1;  ///< of so many one is here
  BlockId values = 0;                  ///< column after column; NaN: nothing
};

/// A number that the page tells, with how it was measured.
struct PageMetric {
  std::string group, name;
  Real value = 0;
  std::string unit, note;
};

struct Page {
  std::string title, name;
  int dimension = 2;
  Vec3 up = Vec3::UnitY();
  std::optional<Real> live;  ///< the page asks every so many seconds whether there is more
  std::string summary;       ///< text of summary.json; empty while the run goes on
  std::string scene_file, scene_text;
  std::vector<PageWarning> warnings;
  std::vector<std::string> notes;  ///< what is not in the page, in words
  std::optional<PageParticles> particles;
  std::optional<PageMesh> mesh;
  std::optional<PageGround> ground;
  std::optional<PageTable> history, run_out;
  std::vector<PageMetric> metrics;
  std::vector<PageBlock> blocks;

  BlockId add(PageBlock block);
  /// What the blocks take in the page [B].
  std::size_t block_bytes() const;
};

/// A table of columns of equal length, of which it keeps about `most` rows, evenly spread, the last one too.
PageTable table_of(const std::vector<CsvColumn>& columns, const std::vector<std::vector<Real>>& values, std::size_t most, Page& page);

/// The page's data as JSON, but for the blocks.
std::string to_json(const Page& page);

/// The template with the page put in its place.  EnvironmentError naming the template: it has no such place.
std::string filled(const std::string& text, const std::filesystem::path& template_file, const Page& page);

}  // namespace talus
