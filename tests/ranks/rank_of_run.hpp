#pragma once
// What a rank has of a run, as far as files need it, and a cloud of particles that tells whether all of it is there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "app/observers/checkpoints.hpp"
#include "app/observers/field_columns.hpp"
#include "app/observers/rank_slices.hpp"
#include "core/error.hpp"
#include "io/checkpoint/serialize.hpp"
#include "io/files/atomic_file.hpp"
#include "materials/neo_hookean.hpp"
#include "materials/von_mises.hpp"
#include "mesh/generate/generate.hpp"
#include "solver/particles/redistribute.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::files_ranks_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

inline constexpr std::int64_t small_piece = 16;

/// Some of the cloud below: what a rank holds of it, in any order.
struct Cloud {
  Particles<2> particles;
  std::vector<Body> bodies{{"low", 0, 0, {}}, {"none", 0, 0, {}}, {"high", 0, 0, {}}};
  std::vector<Material> materials;
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
      cloud.materials.push_back(b == 2 ? make_material(NeoHookean{}, body.begin, body.end, "rubber")
                                       : make_material(VonMises{}, body.begin, body.end, "steel"));
      Material& material = cloud.materials.back();
      for (const HistoryVariable& variable : material.law().variables())
        for (Index i = 0; i < material.size(); ++i)
          for (int c = 0; c < variable.components; ++c)
            history_value(material, variable, i, c) = history(cloud.particles.id[static_cast<std::size_t>(body.begin + i)], c);
    }
    return cloud;
  }
  static Real history(std::int64_t id, int c) { return 0.5 * static_cast<Real>(id) + c; }
  void add(std::int64_t id, Particles<2>& p) const
  {
    const Real number = 1 + static_cast<Real>(id);
    p.id.push_back(id);
    p.cell.push_back(cell(id));
    p.x.push_back({number, -number});
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
      for (const HistoryVariable& variable : cloud.materials[b].law().variables()) {
        ASSERT_EQ(cloud.materials[b].history.size(), cloud.bodies[b].size());
        for (Index i = 0; i < cloud.bodies[b].size(); ++i)
          ASSERT_EQ(history_value(cloud.materials[b], variable, i), history(ids[static_cast<std::size_t>(cloud.bodies[b].begin + i)], 0));
      }
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
  std::vector<VelocityField<2>> fields = std::vector<VelocityField<2>>(1);

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
    problem.subdomain = std::move(part.subdomain);
    for (Index& cell : state.particles.cell)
      cell = problem.subdomain.local_cell(cell);
  }
  void take(Cloud cloud)
  {
    state.particles = std::move(cloud.particles), state.bodies = std::move(cloud.bodies), state.materials = std::move(cloud.materials);
  }
  RunView<2> view() const { return {problem, state, order, fields, "the only", "run", 0, 0}; }
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

}  // namespace talus::files_ranks_test
