// Files that several ranks write and read together: byte by byte those of one, and damage and full disks are told alike.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "app/observers/checkpoints.hpp"
#include "app/observers/output_fields.hpp"
#include "app/observers/rank_slices.hpp"
#include "core/error.hpp"
#include "io/checkpoint/serialize.hpp"
#include "io/files/atomic_file.hpp"
#include "mesh/generate/generate.hpp"
#include "solver/particles/redistribute.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::files_ranks_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::int64_t small_piece = 16;

/// Some of the cloud below: what a rank holds of it, in any order.
struct Cloud {
  Particles<2> particles;
  std::vector<Body> bodies{{"low", 0, 0, {}}, {"none", 0, 0, {}}, {"high", 0, 0, {}}};
  std::vector<AnyBatch> materials;
};

/// A cloud whose every number follows from the id: its first body has three fifths of it, its second one nothing.
struct Maker {
  Index n, cells;
  Index low() const { return n / 5 * 3; }
  Index cell(std::int64_t id) const { return static_cast<Index>(id * 7 % cells); }

  /// Of the ids for which is_mine(id), the later the earlier.
  template <class F>
  Cloud operator()(F&& is_mine) const
  {
    Cloud cloud;
    Index end = 0;
    for (std::size_t b = 0; b < cloud.bodies.size(); ++b) {
      Body& body = cloud.bodies[b];
      body.begin = end;
      for (std::int64_t id = b == 0 ? low() : n; b != 1 && id-- > (b == 0 ? 0 : low());)
        if (is_mine(id)) {
          add(id, cloud.particles);
          ++end;
        }
      body.end = end;
      cloud.materials.push_back(b == 2 ? make_any_batch(NeoHookean{}, body.begin, body.end, "rubber")
                                       : make_any_batch(VonMises{}, body.begin, body.end, "steel"));
      for_each_history(cloud.materials.back(), [&](std::string_view, std::string_view, std::string_view, const auto& column) {
        for (Index i = 0; i < column.size(); ++i)
          for (int c = 0; c < std::decay_t<decltype(column)>::components; ++c)
            column.component(i, c) = history(cloud.particles.id[static_cast<std::size_t>(body.begin + i)], c);
      });
    }
    return cloud;
  }
  static Real history(std::int64_t id, int c) { return 0.5 * static_cast<Real>(id) + c; }
  void add(std::int64_t id, Particles<2>& p) const
  {
    const Real number = 1 + static_cast<Real>(id);
    p.id.push_back(id);
    p.cell.push_back(cell(id));
    p.x.emplace_back(number, -number);
    p.v.push_back({2 * number, 0});
    p.L.push_back(Mat<2>::Constant(number));
    p.F.push_back(Mat3::Identity());
    p.stress.push_back(Sym3::Constant(-number));
    p.mass.push_back(number);
    p.volume0.push_back(number);
    p.volume.push_back(number);
  }
  /// Whether a cloud has these ids, in the order of bodies and ids, with all that is theirs.
  void expect(const Cloud& cloud, const std::vector<std::int64_t>& ids) const
  {
    ASSERT_EQ(cloud.particles.id, ids);
    const auto first_high = std::lower_bound(ids.begin(), ids.end(), low()) - ids.begin();
    const auto end = static_cast<Index>(ids.size());
    EXPECT_EQ(cloud.bodies[0].begin, 0);
    EXPECT_EQ(cloud.bodies[0].end, first_high);
    EXPECT_EQ(cloud.bodies[1].size(), 0);
    EXPECT_EQ(cloud.bodies[2].begin, first_high);
    EXPECT_EQ(cloud.bodies[2].end, end);
    Particles<2> wanted;
    for (const std::int64_t id : ids)
      add(id, wanted);
    const Particles<2>& p = cloud.particles;
    EXPECT_EQ(p.cell, wanted.cell);
    for (std::size_t row = 0; row < ids.size(); ++row) {
      ASSERT_EQ(p.x[row], wanted.x[row]);
      ASSERT_EQ(p.v[row], wanted.v[row]);
      ASSERT_EQ(p.L[row], wanted.L[row]);
      ASSERT_EQ(p.stress[row], wanted.stress[row]);
      ASSERT_EQ(p.mass[row], wanted.mass[row]);
    }
    EXPECT_TRUE(p.C.empty());
    for (std::size_t b = 0; b < cloud.bodies.size(); ++b)
      for_each_history(cloud.materials[b], [&](std::string_view, std::string_view, std::string_view, const auto& column) {
        ASSERT_EQ(column.size(), cloud.bodies[b].size());
        for (Index i = 0; i < column.size(); ++i)
          ASSERT_EQ(column.component(i, 0), history(ids[static_cast<std::size_t>(cloud.bodies[b].begin + i)], 0));
      });
  }
};

/// What a rank has of a run, as far as files need it.
struct RankOfRun {
  Communicator& ranks = world();
  Mesh<2> whole{box<2>({0, 0}, {1, 1}, {24, 24})};
  Problem<2> problem{whole};
  State<2> state{};
  Maker make;
  CellOrder order;
  Nodes<2> nodes;

  explicit RankOfRun(Index n) : make{n, whole.n_cells()}
  {
    std::vector<int> rank_of_block;
    for (Index b = 0; b < blocks_of(whole.n_cells()); ++b)
      rank_of_block.push_back(b % ranks.size());
    problem.ranks = &ranks;
    take(make([&](std::int64_t id) { return rank_of_block[static_cast<std::size_t>(make.cell(id) / block_cells)] == ranks.rank(); }));
    if (ranks.alone())
      return;
    Part<2> part = cut<2>(whole, rank_of_block, ranks.rank(), 1);
    problem.mesh = std::move(part.mesh);
    problem.share = std::move(part.share);
    for (Index& cell : state.particles.cell)
      cell = problem.share.local_cell(cell);
  }
  void take(Cloud cloud)
  {
    state.particles = std::move(cloud.particles), state.bodies = std::move(cloud.bodies), state.materials = std::move(cloud.materials);
  }
  RunView<2> view() const { return {problem, state, order, nodes, "the only", 0, 0}; }
  /// Ids of rows [begin, end) of the file.
  static std::vector<std::int64_t> ids(std::int64_t begin, std::int64_t end)
  {
    std::vector<std::int64_t> all;
    for (; begin < end; ++begin)
      all.push_back(begin);
    return all;
  }
};

/// One folder for all ranks.
class Files : public testing::Test {
 protected:
  void SetUp() override
  {
    std::string path = scratch_.path().string();
    ranks.broadcast(path, 0);
    folder = path;
  }
  void TearDown() override { ranks.barrier(); }
  /// The same on all ranks.
  std::string message_of(const std::function<void()>& action) const
  {
    std::string message = "accepted";
    try {
      action();
    } catch (const EnvironmentError& error) {
      message = error.what();
    }
    std::string of_root = message;
    ranks.broadcast(of_root, 0);
    EXPECT_EQ(message, of_root);
    return message;
  }
  Communicator& ranks = world();
  fs::path folder;

 private:
  ScratchFolder scratch_;
};

TEST(Slices, AreWholePiecesInTheOrderOfRanks)
{
  for (const std::int64_t rows : {0, 1, 15, 16, 17, 160, 161, 1000})
    for (const int n : {1, 2, 3, 7, 40}) {
      const Slices slices{rows, n, small_piece};
      EXPECT_EQ(slices.begin(0), 0);
      EXPECT_EQ(slices.end(n - 1), rows);
      for (int r = 0; r < n; ++r) {
        EXPECT_LE(slices.begin(r), slices.end(r));
        EXPECT_TRUE(slices.of(r).is_whole(static_cast<std::int64_t>(slices.size(r))));
        for (std::int64_t row = slices.begin(r); row < slices.end(r); ++row)
          ASSERT_EQ(slices.rank_of(row), r);
      }
    }
  const Slice late{11, 30, 16, 5};  // pieces of 11, 16 and 3 rows
  EXPECT_EQ(late.pieces(), 3);
  EXPECT_EQ(late.begin_of(1), 11);
  EXPECT_TRUE(late.is_whole(16));
  EXPECT_FALSE(late.is_whole(15));
}

TEST_F(Files, RowsAreDealtOutWithAllThatIsTheirs)
{
  const Maker make{1000, 50};
  Cloud cloud = make([&](std::int64_t id) { return id * 13 % 5 % ranks.size() == ranks.rank(); });
  std::vector<int> to;
  for (const std::int64_t id : cloud.particles.id)
    to.push_back(static_cast<int>(id % 3) % ranks.size());  // nothing for a fourth
  redistribute(ranks, to, cloud.bodies, cloud.materials, cloud.particles);
  std::vector<std::int64_t> ids;
  for (std::int64_t id = 0; id < make.n; ++id)
    if (id % 3 % ranks.size() == ranks.rank())
      ids.push_back(id);
  make.expect(cloud, ids);
  EXPECT_EQ(cloud.particles.x.size(), ids.size());
  to.assign(ids.size(), ranks.size() - 1);
  redistribute(ranks, to, cloud.bodies, cloud.materials, cloud.particles);  // from ranks without any
  make.expect(cloud, ranks.rank() == ranks.size() - 1 ? RankOfRun::ids(0, make.n) : std::vector<std::int64_t>());
}

TEST_F(Files, SlicesHaveTheRowsOfTheFile)
{
  const RankOfRun run(1000);
  const auto slice = slice_of_particles(run.view(), small_piece);
  const Slices slices{1000, ranks.size(), small_piece};
  EXPECT_EQ(slice.rows.first, slices.begin(ranks.rank()));
  EXPECT_EQ(slice.rows.of_all, 1000);
  run.make.expect({slice.state.particles, slice.state.bodies, slice.state.materials}, run.ids(slice.rows.first, slices.end(ranks.rank())));
  EXPECT_EQ(slice.whole_bodies[0].end, run.make.low());
  EXPECT_EQ(slice.whole_bodies[2].begin, run.make.low());
  EXPECT_EQ(slice.whole_bodies[2].end, 1000);
  EXPECT_EQ(doubled_id(ranks, run.state.particles.id), std::nullopt);
  std::vector<std::int64_t> ids = run.state.particles.id;
  ids.push_back(ranks.is_root() ? 50 : 30);
  EXPECT_EQ(doubled_id(ranks, ids), ranks.alone() ? 50 : 30);
}

TEST_F(Files, ParticlesAreWrittenAsByOneRank)
{
  const RankOfRun run(1000);
  const auto write = [&](Communicator& by, const Particles<2>& particles, const Slice& rows, const fs::path& file) {
    const auto in_order = rows_by_id(particles);
    std::vector<std::int64_t> ids;
    Column heat{"heat", 1, {}, "J"}, speed{"a<b", 3, {}};
    for (const Index row : in_order) {
      ids.push_back(particles.id[static_cast<std::size_t>(row)]);
      heat.values.push_back(static_cast<float>(ids.back() % 10));
      speed.values.insert(speed.values.end(), 3, static_cast<float>(ids.back()));
    }
    write_particles(by, file, 0.5, rows, positions(particles, in_order), ids, std::vector<Column>{heat, speed}, "this test");
  };
  const auto slice = slice_of_particles(run.view(), small_piece);
  write(ranks, slice.state.particles, slice.rows, folder / "all.vtp");
  if (!ranks.is_root())
    return;
  const Cloud whole = run.make([](std::int64_t) { return true; });
  write(one_rank(), whole.particles, {0, 1000, small_piece}, folder / "one.vtp");
  EXPECT_TRUE(read_whole(folder / "all.vtp") == read_whole(folder / "one.vtp"));
  const StoredParticles read = read_particles(folder / "all.vtp");
  EXPECT_EQ(read.ids, run.ids(0, 1000));
  EXPECT_EQ(read.fields[0].values[3 * 999], 1000);
  EXPECT_EQ(read.fields[2].name, "a<b");
  EXPECT_EQ(read.fields[2].values.back(), 999);
  EXPECT_EQ(read.made_by, "this test");
}

TEST_F(Files, MeshesAreWrittenAsByOneRank)
{
  const RankOfRun run(10);
  Column held{"number", 1, {}, "m"};
  for (Index n = 0; n < run.problem.mesh.n_nodes(); ++n)
    held.values.push_back(static_cast<float>(ranks.alone() ? n : run.problem.share.node[static_cast<std::size_t>(n)]));
  Column column = slice_of_column(run.view(), held, small_piece);
  write_mesh(ranks, folder / "all.vtu", 0.5, slice_of_mesh(run.view(), small_piece), std::vector<Column>{column}, {});
  if (!ranks.is_root())
    return;
  column.values.clear();
  for (Index n = 0; n < run.whole.n_nodes(); ++n)
    column.values.push_back(static_cast<float>(n));
  MeshSlice whole{2, {0, run.whole.n_nodes(), small_piece}, {}, {0, run.whole.n_cells(), small_piece}, {}};
  for (const auto& x : run.whole.nodes())
    whole.positions.insert(whole.positions.end(), {x[0], x[1], 0});
  for (const auto& cell : run.whole.cells())
    whole.corners.insert(whole.corners.end(), cell.begin(), cell.end());
  write_mesh(one_rank(), folder / "one.vtu", 0.5, whole, std::vector<Column>{column}, {});
  EXPECT_TRUE(read_whole(folder / "all.vtu") == read_whole(folder / "one.vtu"));
  write_mesh<2>(folder / "plain.vtu", 0.5, run.whole, std::vector<Column>{column}, {});  // in larger pieces
  for (const char* name : {"one.vtu", "plain.vtu"}) {
    const StoredMeshFields read = read_mesh_fields(folder / name);
    EXPECT_EQ(read.nodes[0].values, whole.positions);
    EXPECT_EQ(read.nodes[1].values.back(), static_cast<Real>(run.whole.n_nodes() - 1));
  }
}

/// The particles, and the history of the last body.
void write_cloud(Communicator& by, const fs::path& file, const Cloud& cloud, const std::vector<Body>& in_file, const Slice& rows)
{
  std::vector<SharedArray> arrays;
  share_columns("particles", cloud.particles, rows, arrays);
  const Body &all = in_file[2], &here = cloud.bodies[2];
  const Slice of_body{here.size() > 0 ? rows.first + here.begin - all.begin : 0, all.size(), rows.piece, all.begin % rows.piece};
  share_history("history", cloud.materials[2], of_body, arrays);
  write_arrays(by, file, arrays, [&](ArrayWriter& rest) { save(rest, "words", std::string("of the root")); });
}

TEST_F(Files, ArraysAreWrittenAsByOneRankAndReadInSlices)
{
  const RankOfRun run(1000);
  const auto slice = slice_of_particles(run.view(), small_piece);
  write_cloud(ranks, folder / "all.h5", {slice.state.particles, slice.state.bodies, slice.state.materials}, slice.whole_bodies, slice.rows);
  Cloud whole = run.make([](std::int64_t) { return true; });
  redistribute(one_rank(), std::vector<int>(1000, 0), whole.bodies, whole.materials, whole.particles);
  if (ranks.is_root()) {
    write_cloud(one_rank(), folder / "one.h5", whole, whole.bodies, {0, 1000, small_piece});
    EXPECT_TRUE(read_whole(folder / "all.h5") == read_whole(folder / "one.h5"));
  }
  ranks.barrier();
  {
    const ArrayReader arrays(folder / "all.h5");
    EXPECT_EQ(arrays.text("words"), "of the root");
    EXPECT_EQ(arrays.read<std::int64_t>("particles/id"), run.ids(0, 1000));
    for (const std::size_t first : {0U, 15U, 16U, 500U, 999U, 1000U})
      for (const std::size_t n : {0U, 1U, 16U, 17U, 300U, 1000U}) {
        if (first + n > 1000)
          continue;
        std::vector<Real> x(2 * n);
        arrays.read_rows<Real>("particles/position", first, x, 2);
        for (std::size_t i = 0; i < n; ++i)
          ASSERT_EQ(x[2 * i], static_cast<Real>(first + i + 1));
      }
    std::vector<Real> too_many(2 * 2);
    EXPECT_THAT(message_of([&] { arrays.read_rows<Real>("particles/position", 999, too_many, 2); }), HasSubstr("has 1000 rows, not 1001"));
  }
  // One byte of one piece: of a number that the file has only there.
  ranks.barrier();
  if (ranks.is_root()) {
    std::string bytes = read_whole(folder / "all.h5");
    const Real number = -701;  // y of row 700, in the piece of rows 688 to 703
    const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&number), sizeof number));
    ASSERT_NE(at, bytes.npos);
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    write_whole(folder / "all.h5", bytes);
  }
  ranks.barrier();
  const ArrayReader arrays(folder / "all.h5");
  std::vector<Real> x(2 * 100);
  arrays.read_rows<Real>("particles/position", 500, x, 2);
  EXPECT_EQ(x[0], 501);
  EXPECT_THAT(message_of([&] { arrays.read_rows<Real>("particles/position", 590, x, 2); }), HasSubstr("position is damaged"));
  EXPECT_THAT(message_of([&] { arrays.read<Real>("particles/position", 2); }), HasSubstr("position is damaged"));
}

TEST_F(Files, AFullDiskOfOneRankIsToldByAllAndLeavesWhatWasThere)
{
  const RankOfRun run(5000);
  const auto slice = slice_of_particles(run.view(), small_piece);
  const auto write = [&](const fs::path& file) {
    write_cloud(ranks, file, {slice.state.particles, slice.state.bodies, slice.state.materials}, slice.whole_bodies, slice.rows);
  };
  const auto write_vtp = [&](const fs::path& file) {
    const auto rows = rows_by_id(slice.state.particles);
    write_particles(ranks, file, 0, slice.rows, positions(slice.state.particles, rows), slice.state.particles.id, {});
  };
  if (ranks.is_root())
    for (const char* name : {"a.h5", "a.vtp"})
      write_whole(folder / name, "as it was");
  ranks.barrier();
  {
    std::optional<FullDisk> full;
    if (ranks.rank() == ranks.size() - 1)
      full.emplace(20'000);
    EXPECT_THAT(message_of([&] { write(folder / "a.h5"); }), HasSubstr("File too large"));
    EXPECT_THAT(message_of([&] { write_vtp(folder / "a.vtp"); }),
                HasSubstr("cannot write " + (folder / "a.vtp").string() + ": File too large"));
  }
  ranks.barrier();
  if (ranks.is_root())
    for (const char* name : {"a.h5", "a.vtp"}) {
      EXPECT_EQ(read_whole(folder / name), "as it was");
      EXPECT_FALSE(fs::exists(folder / (std::string(name) + ".tmp")));
    }
  ranks.barrier();
  write(folder / "a.h5");
  EXPECT_EQ(ArrayReader(folder / "a.h5").rows("particles/id"), 5000U);
}

TEST_F(Files, ACheckpointIsTakenOverInSlicesAndRefusedByAllWhereOneOfThemIsDamaged)
{
  constexpr Index n = 3 * rows_of_a_piece - 100;
  RankOfRun run(n);
  const OutputSpec outputs;
  const std::vector<Stage> stages(1);
  Recorder<2> recorder(folder, outputs, stages, true, "");
  if (ranks.is_root())
    write_whole(folder / "summary.json", "{}\n");
  Checkpoints<2> checkpoints(folder, CheckpointSpec{}, {"0.1", "commit", "compiler", "build", "scene.yaml", "", {}, false, 1, 2, ""});
  checkpoints.write(run.view(), recorder);
  run.state.clock.step = 1;
  checkpoints.write(run.view(), recorder);
  const fs::path newest = checkpoints.last();

  RankOfRun other(n);
  const StateLimits limits{other.whole.n_cells(), 1, n};
  other.take(other.make([](std::int64_t) { return false; }));
  EXPECT_EQ(CheckpointList(folder).take_over(other.state, recorder, limits), newest);
  EXPECT_EQ(other.state.clock.step, 1);
  const Slices slices{n, ranks.size()};
  EXPECT_EQ(other.state.particles.size(), static_cast<Index>(slices.size(ranks.rank())));
  if (!ranks.alone()) {
    receive_owned_particles(ranks, other.problem.share, other.state.bodies, other.state.materials, other.state.particles);
    for (const Index cell : other.state.particles.cell)
      ASSERT_TRUE(other.problem.share.owns_cell(cell));
    for (Index& cell : other.state.particles.cell)
      cell = other.problem.share.whole_cell(cell);
    std::vector<std::int64_t> ids = run.state.particles.id;
    std::sort(ids.begin(), ids.end());
    other.make.expect({other.state.particles, other.state.bodies, other.state.materials}, ids);
  }

  ranks.barrier();
  if (ranks.is_root()) {
    std::string bytes = read_whole(newest);
    const Real number = -(n - 10 + 1.0);  // y of a row in the last piece
    const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&number), sizeof number));
    ASSERT_NE(at, bytes.npos);
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    write_whole(newest, bytes);
  }
  ranks.barrier();
  EXPECT_THAT(message_of([&] { CheckpointList(newest).take_over(other.state, recorder, limits); }),
              testing::AllOf(HasSubstr(newest.string() + ": particles/"), HasSubstr("is damaged")));
  EXPECT_NE(CheckpointList(folder).take_over(other.state, recorder, limits), newest) << "the one before";
  EXPECT_EQ(other.state.clock.step, 0);
}

}  // namespace
}  // namespace talus::files_ranks_test
