// Arrays and checkpoints that several ranks write and read.
#include "tests/ranks/rank_of_run.hpp"

namespace talus::files_ranks_test {
namespace {

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
    receive_owned_particles(ranks, other.problem.subdomain, other.state.bodies, other.state.materials, other.state.particles);
    for (const Index cell : other.state.particles.cell)
      ASSERT_TRUE(other.problem.subdomain.owns_cell(cell));
    for (Index& cell : other.state.particles.cell)
      cell = other.problem.subdomain.whole_cell(cell);
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
