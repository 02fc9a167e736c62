// Frames that are written while the run goes on: the same bytes, in order, and no failure is lost.
#include "app/observers/frame_output.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "mesh/generate/generate.hpp"
#include "tests/app/program.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::frame_output_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class Frames : public testing::Test {
 protected:
  static constexpr std::size_t n = 70000;  // more than two blocks of a file
  ScratchFolder folder_;

  fs::path particle_file(int number) const { return folder_ / fmt::format("particles_{:04}.vtp", number); }
  fs::path mesh_file(int number) const { return folder_ / fmt::format("mesh_{:04}.vtu", number); }

  static Frame::ParticleFile particles(const fs::path& file)
  {
    Frame::ParticleFile part{file, {0, n}, std::vector<Real>(3 * n), std::vector<std::int64_t>(n), {{"velocity", 3, {}, "m/s"}}};
    part.columns[0].values.resize(3 * n);
    for (std::size_t i = 0; i < 3 * n; ++i) {
      part.positions[i] = std::sin(static_cast<Real>(i));
      part.columns[0].values[i] = std::cos(static_cast<float>(i));
      part.ids[i / 3] = static_cast<std::int64_t>(2 * (i / 3));
    }
    return part;
  }
  /// A square of two triangles.
  static Frame::MeshFile mesh(const fs::path& file)
  {
    return {file, {2, {0, 4}, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, {0, 2}, {0, 1, 2, 0, 2, 3}}, {{"mass", 1, {1, 2, 3, 4}, "kg"}}};
  }
  Frame frame(int number) const { return {number * 0.5, particles(particle_file(number)), mesh(mesh_file(number)), {}}; }
};

TEST_F(Frames, HaveTheBytesOfFilesThatAreWrittenAtOnce)
{
  FrameOutput writer(folder_.path(), "talus");
  Communicator alone;
  writer.write(alone, frame(0));
  EXPECT_TRUE(writer.is_pending());
  writer.wait();
  EXPECT_FALSE(writer.is_pending());
  const auto at_once = particles(folder_ / "at_once.vtp");
  write_particles(at_once.file, 0, at_once.positions, at_once.ids, at_once.columns, "talus");
  EXPECT_TRUE(read_whole(particle_file(0)) == read_whole(at_once.file));
  const auto mesh_at_once = mesh(folder_ / "at_once.vtu");
  write_mesh(alone, mesh_at_once.file, 0, mesh_at_once.mesh, mesh_at_once.columns, {}, "talus");
  EXPECT_TRUE(read_whole(mesh_file(0)) == read_whole(mesh_at_once.file));
}

TEST_F(Frames, AreNamedInTheirListsOneAfterTheOther)
{
  FrameOutput writer(folder_.path(), "");
  Communicator alone;
  for (int number = 0; number < 5; ++number) {
    writer.write(alone, frame(number));
    if (number > 0) {  // the frame before is on the disk, and named
      EXPECT_TRUE(fs::exists(particle_file(number - 1)));
      EXPECT_TRUE(fs::exists(mesh_file(number - 1)));
      EXPECT_GE(read_pvd(folder_ / "mesh.pvd").size(), static_cast<std::size_t>(number));
    }
  }
  writer.wait();
  EXPECT_THAT(writer.written(), ElementsAre("particles_0004.vtp", "mesh_0004.vtu"));
  for (const char* const name : {"particles.pvd", "mesh.pvd"}) {
    const auto list = read_pvd(folder_ / name);
    ASSERT_EQ(list.size(), 5U);
    for (std::size_t i = 0; i < list.size(); ++i) {
      EXPECT_EQ(list[i].first, 0.5 * static_cast<Real>(i));
      EXPECT_TRUE(fs::exists(list[i].second)) << list[i].second;
    }
  }
}

TEST_F(Frames, AFailureIsThrownOnceWithTheNameOfTheFileAndWhatWasWrittenBefore)
{
  FrameOutput writer(folder_.path(), "");
  Communicator alone;
  fs::create_directories(folder_ / "mesh_0001.vtu.tmp/in_the_way");
  writer.write(alone, frame(0));
  writer.write(alone, frame(1));
  try {
    writer.wait();
    FAIL() << "the failure was lost";
  } catch (const EnvironmentError& e) {
    EXPECT_THAT(e.what(), HasSubstr("mesh_0001.vtu"));
  }
  EXPECT_THAT(writer.written(), ElementsAre("particles_0001.vtp"));
  EXPECT_EQ(read_pvd(folder_ / "mesh.pvd").size(), 1U);
  EXPECT_NO_THROW(writer.wait());
}

TEST_F(Frames, AFailureIsThrownByTheNextFrameWhichIsNotWritten)
{
  FrameOutput writer(folder_.path(), "");
  Communicator alone;
  fs::create_directories(folder_ / "particles_0000.vtp.tmp/in_the_way");
  writer.write(alone, frame(0));
  EXPECT_THROW(writer.write(alone, frame(1)), EnvironmentError);
  EXPECT_FALSE(fs::exists(particle_file(1)));
}

TEST_F(Frames, TheEndOfTheWriterWaitsForItsFrame)
{
  {
    FrameOutput writer(folder_.path(), "");
    Communicator alone;
    writer.write(alone, frame(0));
  }
  EXPECT_EQ(read_pvd(folder_ / "mesh.pvd").size(), 1U);
}

class FramesOfARun : public Program {
 protected:
  void SetUp() override
  {
    write("scene.yaml", block_scene("loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}]\n"
                                    "time: {end: 0.1, max_step: 1.0e-3}\n"
                                    "outputs: {particles: {every: 0.01}, mesh: {every: 0.01}, checkpoint: {steps: 25}}\n"));
  }
};

/// A file of a frame that cannot be written, in the midst of a run.
TEST_F(FramesOfARun, ThatCannotBeWrittenEndItWithTheLastGoodOne)
{
  ASSERT_EQ(talus("run scene.yaml --quiet --out whole").code, 0);
  ASSERT_EQ(talus("run scene.yaml --quiet --out out --until 25").code, 4);
  const auto last = read_pvd(folder_ / "out/particles.pvd").size() - 1;
  const std::string blocked = fmt::format("particles_{:04}.vtp", last + 3);
  fs::create_directories(folder_ / ("out/" + blocked + ".tmp/in_the_way"));
  const Outcome outcome = talus("run --resume out --quiet");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("out/" + blocked));
  EXPECT_THAT(outcome.err, HasSubstr(fmt::format("last good output out/particles_{:04}.vtp", last + 2)));
  EXPECT_EQ(read("out/summary.json").find(blocked + "\""), std::string::npos);
  EXPECT_EQ(read_pvd(folder_ / "out/particles.pvd").size(), last + 3);
  fs::remove_all(folder_ / ("out/" + blocked + ".tmp"));
  ASSERT_EQ(talus("run --resume out --quiet").code, 0);
  for (const char* const list : {"particles.pvd", "mesh.pvd"})
    for (const auto& entry : read_pvd(folder_ / ("whole/" + std::string(list)))) {
      const std::string name = entry.second.filename().string();
      EXPECT_TRUE(read("out/" + name) == read("whole/" + name)) << name;
    }
  EXPECT_EQ(read("out/particles.pvd"), read("whole/particles.pvd"));
}

}  // namespace
}  // namespace talus::frame_output_test
