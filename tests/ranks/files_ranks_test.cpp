// Files that several ranks write and read together: byte by byte those of one, and damage and full disks are told alike.
#include "tests/ranks/rank_of_run.hpp"

namespace talus::files_ranks_test {
namespace {

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
    held.values.push_back(static_cast<float>(ranks.alone() ? n : run.problem.subdomain.node[static_cast<std::size_t>(n)]));
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

TEST_F(Files, AFieldThatThereIsNotIsNoColumnOfZeros)
{
  const RankOfRun run(10);
  const auto rows = rows_by_id(run.state.particles);
  EXPECT_THROW(particle_column(run.problem, run.state, rows, "sped"), std::invalid_argument);
  EXPECT_THROW(node_column(run.view(), "stress"), std::invalid_argument);
  const Column strain = particle_column(run.problem, run.state, rows, "plastic_strain");  // of the law of the first body alone
  const Column opened = particle_column(run.problem, run.state, rows, "opened_volume");  // of no law in this run, but a stage may bring one
  EXPECT_EQ(strain.values.size(), rows.size());
  EXPECT_EQ(opened.values, std::vector<float>(rows.size(), 0));
}

}  // namespace
}  // namespace talus::files_ranks_test
