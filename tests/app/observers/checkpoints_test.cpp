// Checkpoints that are written while the run goes on: the same bytes, in order, and no failure is lost.
#include "app/observers/checkpoints.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cmath>
#include <future>
#include <thread>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/file_descriptor.hpp"
#include "materials/von_mises.hpp"
#include "mesh/generate/generate.hpp"
#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::checkpoints_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Particles with numbers that all differ, as they are between two steps; `take_copy` gives a copy of them as strips do.
struct Steps {
  static constexpr Index n = rows_of_a_piece + 100;  // two pieces of a file
  Problem<2> problem{Mesh<2>(box<2>({0, 0}, {1, 1}, {2, 2}))};
  State<2> state{};
  CellOrder order;
  std::vector<VelocityField<2>> fields;

  Steps()
  {
    state.bodies = {{"block", 0, n, {}}};
    state.materials.push_back(make_material(VonMises{}, 0, n, "steel"));
    Particles<2>& p = state.particles;
    const auto make_room = [](auto&... columns) { (columns.resize(to_size(n)), ...); };
    make_room(p.id, p.cell, p.x, p.v, p.L, p.F, p.stress, p.mass, p.volume0, p.volume);
    p.for_each_column([&](std::string_view, std::string_view, auto& column) {
      using Number = typename RowsOf<std::decay_t<decltype(column)>>::Number;
      for (std::size_t k = 0; k < column.size() * RowsOf<std::decay_t<decltype(column)>>::components; ++k)
        numbers_of(column, 0)[k] = static_cast<Number>(k);
    });
    state.boundary.add({.name = "floor", .kind = Fixed<2>{}}, problem.mesh, std::vector<Index>{0, 1});
  }
  RunView<2> in_columns() const { return {problem, state, order, fields, "the only", "run", 0, 0}; }
  RunView<2> in_strips() const
  {
    RunView<2> view = in_columns();
    view.take_copy = [this] { return std::optional(ParticleCopy<2>{state.bodies, state.materials, state.particles}); };
    return view;
  }
  /// Changes every number.
  void go_on()
  {
    ++state.clock.step;
    state.clock.time += 0.5;
    state.energy.internal += 1;
    state.particles.v.assign(to_size(n), Vec<2>::Constant(-1));
    state.particles.stress.assign(to_size(n), Sym3::Constant(-1));
    for (Index i = 0; i < n; ++i)
      state.materials[0].history.row(i)[0] -= 1;
  }
};

class CheckpointsBesideSteps : public testing::Test {
 protected:
  ScratchFolder folder_;
  OutputSpec outputs_;
  std::vector<Stage> stages_{1};
  Recorder<2> recorder_{folder_.path(), outputs_, stages_, true, ""};
  Steps run_;

  fs::path results(const std::string& name) const
  {
    write_whole(folder_ / (name + "/summary.json"), "{}\n");
    return folder_ / name;
  }
  static CheckpointSpec each(Index steps) { return {.every = {}, .steps = steps}; }
  static RunIdentity identity() { return {"0.1", "commit", "compiler", "build", "scene.yaml", "title: x\n", {}, false, 1, 2, ""}; }
  static fs::path file(const fs::path& results, int step) { return results / fmt::format("checkpoints/step_{:09}.h5", step); }
  /// Sees the steps up to this one.
  void go_to(std::int64_t step, Checkpoints<2>& checkpoints)
  {
    for (checkpoints.see(run_.in_strips(), recorder_); run_.state.clock.step < step; checkpoints.see(run_.in_strips(), recorder_))
      run_.go_on();
  }
};

TEST_F(CheckpointsBesideSteps, HaveTheBytesOfOnesThatAreWrittenAtOnce)
{
  const fs::path at_once = results("at_once"), beside = results("beside");
  Checkpoints<2> direct(at_once, {}, identity()), background(beside, each(3), identity());
  go_to(2, background);
  run_.go_on();
  direct.write(run_.in_columns(), recorder_);
  background.see(run_.in_strips(), recorder_);
  EXPECT_TRUE(background.is_pending());
  EXPECT_TRUE(background.last().empty()) << "it is not known to be on the disk";
  run_.go_on();
  background.finish();
  EXPECT_FALSE(background.is_pending());
  EXPECT_EQ(background.last(), file(beside, 3));
  EXPECT_EQ(background.last_step(), 3);
  EXPECT_GT(fs::file_size(file(beside, 3)), 30U * 8U * static_cast<std::size_t>(Steps::n));
  EXPECT_TRUE(read_whole(file(beside, 3)) == read_whole(file(at_once, 3)));
  go_to(6, background);
  background.finish();
  EXPECT_FALSE(read_whole(file(beside, 6)) == read_whole(file(at_once, 3))) << "the steps change nothing";
}

/// A pipe without a reader holds up the thread that writes.
TEST_F(CheckpointsBesideSteps, DoNotDelayStepsUntilTheNextIsDueAndFailuresNameTheStep)
{
  const fs::path out = results("out");
  Checkpoints<2> checkpoints(out, each(10), identity());
  go_to(10, checkpoints);
  checkpoints.finish();
  const fs::path pipe = file(out, 20).string() + ".tmp";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  go_to(29, checkpoints);
  EXPECT_TRUE(checkpoints.is_pending());
  EXPECT_EQ(checkpoints.last_step(), 10);
  EXPECT_FALSE(fs::exists(file(out, 20)));
  auto next = std::async(std::launch::async, [&] { go_to(30, checkpoints); });
  EXPECT_EQ(next.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout) << "two are written at once";
  const FileDescriptor reader(pipe, O_RDONLY | O_NONBLOCK);
  try {
    next.get();
    FAIL() << "a checkpoint was written into a pipe";
  } catch (const EnvironmentError& e) {
    EXPECT_THAT(e.what(), HasSubstr("cannot write " + file(out, 20).string()));
    EXPECT_THAT(e.what(), HasSubstr("(checkpoint after step 20, t = 10 s)"));
  }
  EXPECT_EQ(checkpoints.last(), file(out, 10));
  EXPECT_FALSE(fs::exists(pipe));
  EXPECT_NO_THROW(checkpoints.finish()) << "it is told once";
  run_.go_on();
  checkpoints.write(run_.in_strips(), recorder_);
  EXPECT_EQ(checkpoints.last_step(), 31);
}

TEST_F(CheckpointsBesideSteps, AFailureIsToldBeforeTheNextIsDue)
{
  const fs::path out = results("out");
  Checkpoints<2> checkpoints(out, each(1'000'000), identity());
  checkpoints.see(run_.in_strips(), recorder_);
  run_.state.clock.step = 999'999;
  fs::create_directories(file(out, 1'000'000).string() + ".tmp/in_the_way");
  std::string told;
  for (int step = 0; told.empty() && step < 10'000; ++step) {
    run_.go_on();
    try {
      checkpoints.see(run_.in_strips(), recorder_);
    } catch (const EnvironmentError& e) {
      told = e.what();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_THAT(told, HasSubstr("step_001000000.h5"));
  EXPECT_THAT(told, HasSubstr("checkpoint after step 1000000,"));
  EXPECT_TRUE(checkpoints.last().empty());
}

TEST_F(CheckpointsBesideSteps, TheEndOfTheRunWaits)
{
  const fs::path out = results("out");
  Checkpoints<2> checkpoints(out, each(5), identity());
  go_to(5, checkpoints);
  checkpoints.see_end_of_stage(run_.in_columns(), recorder_, 2);
  EXPECT_TRUE(checkpoints.is_pending()) << "another stage follows";
  checkpoints.see_end_of_stage(run_.in_columns(), recorder_, 1);
  EXPECT_FALSE(checkpoints.is_pending());
  EXPECT_TRUE(fs::exists(file(out, 5)));
  {
    Checkpoints<2> others(out, each(8), identity());
    go_to(8, others);
  }
  EXPECT_TRUE(fs::exists(file(out, 8))) << "an exception of another kind ends the run";
}

TEST_F(CheckpointsBesideSteps, OlderOnesAreRemovedOnceTheNewOneIsThere)
{
  const fs::path out = results("out");
  Checkpoints<2> checkpoints(out, each(2), identity());  // two are kept
  for (int step = 2; step <= 10; step += 2) {
    go_to(step, checkpoints);
    checkpoints.finish();
    EXPECT_TRUE(fs::exists(file(out, step)));
    EXPECT_EQ(std::distance(fs::directory_iterator(out / "checkpoints"), {}), std::min(step / 2, 2));
  }
}

class CheckpointsOfARun : public Program {
 protected:
  void SetUp() override
  {
    write("scene.yaml", block_scene("loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}]\n"
                                    "time: {end: 0.05, max_step: 1.0e-3}\n"
                                    "outputs: {particles: {every: 1.0e-3}, history: {every: 1.0e-3}, "
                                    "checkpoint: {steps: 10, keep: 100, at_end: true}}\n"));
  }
};

/// A checkpoint that cannot be written, in the midst of a run.
TEST_F(CheckpointsOfARun, ThatCannotBeWrittenEndItWithTheLastGoodOne)
{
  ASSERT_EQ(talus("run scene.yaml --quiet --out whole").code, 0);
  ASSERT_EQ(talus("run scene.yaml --quiet --out out --until 10").code, 4);
  fs::create_directories(folder_ / "out/checkpoints/step_000000030.h5.tmp/in_the_way");
  const Outcome outcome = talus("run --resume out --quiet");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("out/checkpoints/step_000000030.h5"));
  EXPECT_THAT(outcome.err, HasSubstr("(checkpoint after step 30, t = "));
  EXPECT_THAT(outcome.err, HasSubstr("last checkpoint out/checkpoints/step_000000020.h5"));
  EXPECT_THAT(read("out/summary.json"), HasSubstr("\"status\": \"failed\""));
  fs::remove_all(folder_ / "out/checkpoints/step_000000030.h5.tmp");
  ASSERT_EQ(talus("run --resume out --quiet").code, 0);
  expect_same_results(folder_ / "whole", folder_ / "out");
}

/// Each is written in the background in one run, and before the run stops in another.
TEST_F(CheckpointsOfARun, AreThoseOfRunsThatStopThere)
{
  ASSERT_EQ(talus("run scene.yaml --quiet --out whole").code, 0);
  for (const int step : {10, 20, 40}) {
    ASSERT_EQ(talus(fmt::format("run scene.yaml --quiet --out out --force --until {}", step)).code, 4);
    const std::string name = fmt::format("checkpoints/step_{:09}.h5", step);
    expect_same_state(folder_ / ("whole/" + name), folder_ / ("out/" + name));
  }
}

/// The frame of the same step may still be written when the copy of a checkpoint is made.
TEST_F(CheckpointsOfARun, NameTheFramesThatAreOnTheDiskWithThem)
{
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  int checked = 0;
  for (const fs::path& checkpoint : files_in(folder_ / "out/checkpoints", ".h5")) {
    const ArrayReader arrays(checkpoint);
    const auto frames = arrays.read<std::int32_t>("recorder/particle_files");
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_GT(frames[0], 10);
    EXPECT_EQ(arrays.text("recorder/last_output"), fmt::format("particles_{:04}.vtp", frames[0] - 1));
    ++checked;
  }
  EXPECT_GE(checked, 5);
}

}  // namespace
}  // namespace talus::checkpoints_test
