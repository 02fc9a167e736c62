// A script in Python that a run calls between its steps.
#include <gmock/gmock.h>
#include <algorithm>

#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::script_test {

namespace {

using testing::HasSubstr;
using testing::Not;

class Script : public Program {
 protected:
  void SetUp() override
  {
    write("scene.yaml",
          block_scene(
              "loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}]\n"
              "time: {end: 0.1, max_step: 2.0e-3}\n"
              "outputs: {history: {every: 0.01, points: [{name: top, at: [1, 1]}]}, checkpoint: {steps: 20, keep: 1000, at_end: true}}\n",
              ", velocity: [1, -2]"));
  }
  Outcome run(const std::string& script, const std::string& out, const std::string& more = "") const
  {
    write(out + ".py", script);
    return talus("run scene.yaml --quiet --script " + out + ".py --out " + out + " " + more);
  }
  std::filesystem::path newest(const std::string& run) const { return files_in(folder_ / run / "checkpoints", ".h5").back(); }
  void expect_same(const std::string& a, const std::string& b) const
  {
    EXPECT_EQ(read(a + "/history.csv"), read(b + "/history.csv"));
    expect_same_state(newest(a), newest(b), "run/set");
  }
};

/// Whatever it reads and keeps, with checkpoints and files that are written meanwhile.
TEST_F(Script, ThatChangesNothingChangesNoBit)
{
  const Outcome plain = talus("run scene.yaml --quiet --out plain");
  ASSERT_EQ(plain.code, 0) << plain.err;
  const Outcome outcome = run(R"py(
kept = []

def step(simulation):
    for name in simulation.particles:
        kept.append(simulation.particles[name])
    for name in simulation.nodes:
        simulation.nodes[name]
    simulation.bodies["block"]["stress"].sum()
)py",
                              "read");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_same("read", "plain");
}

/// Packages change how a processor treats small numbers and rounds; steps depend on it.
TEST_F(Script, LeavesArithmeticAsItWas)
{
  const Outcome plain = talus("run scene.yaml --quiet --out plain --threads 1");
  ASSERT_EQ(plain.code, 0) << plain.err;
  const Outcome outcome = run(R"py(
import ctypes
upwards = 0x800
libm = ctypes.CDLL("libm.so.6")

def step(simulation):
    assert libm.fesetround(upwards) == 0
)py",
                              "rounds", "--threads 1");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_same("rounds", "plain");
}

TEST_F(Script, IsCalledAfterEverySoManySteps)
{
  const Outcome outcome = run(R"py(
def start(simulation):
    print("start", simulation.step)

def step(simulation):
    print("step", simulation.step)

def end(simulation):
    print("end", simulation.step, simulation.history["time"] == simulation.time)
)py",
                              "out", "--set script.every=20 --set time.end=0.12");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "start 0\nstep 20\nstep 40\nstep 60\nend 60 True\n");
  EXPECT_THAT(read("out/summary.json"), HasSubstr("\"script\""));
}

TEST_F(Script, EndsTheRunByAnException)
{
  const Outcome outcome =
      run("def step(simulation):\n    if simulation.step == 25:\n        helper()\n\ndef helper():\n    1 / 0\n", "out");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("Traceback"));
  EXPECT_THAT(outcome.err, HasSubstr("step 25, t = "));
  EXPECT_THAT(outcome.err, HasSubstr("out.py:6: in helper(): ZeroDivisionError: division by zero"));
  EXPECT_THAT(outcome.err, HasSubstr("step_000000020.h5"));
  EXPECT_THAT(read("out/summary.json"), HasSubstr("\"failed\""));
}

TEST_F(Script, ThatLeavesPythonEndsTheRunAsAnyException)
{
  const Outcome outcome = run("import sys\ndef step(simulation):\n    sys.exit(0)\n", "out");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("out.py:3: in step(): SystemExit: 0"));
}

TEST_F(Script, IsReadBeforeResultsAreReplaced)
{
  const auto is_refused = [&](const std::string& script, const std::string& message) {
    const Outcome outcome = run(script, "out");
    EXPECT_EQ(outcome.code, 2) << script;
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_FALSE(exists("out"));
  };
  is_refused("def step(simulation):\n    x = = 2\n", "out.py:2:9: SyntaxError: invalid syntax");
  is_refused("import no_such_package\n", "out.py:1: ModuleNotFoundError: No module named 'no_such_package'");
  is_refused("x = 1\n", "it has none of the functions start, step, history and end");
  is_refused("step = 1\n", "step is not a function");
  is_refused("def history(simulation): pass\n", "history() needs a dictionary columns");
  is_refused("columns = {'a': 'm'}\ndef step(simulation): pass\n", "columns need the function history");
  const Outcome missing = talus("run scene.yaml --script nowhere.py --out out");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, HasSubstr("nowhere.py: the file cannot be read"));
  EXPECT_FALSE(exists("out"));
}

/// end() is called, and the run goes on bitwise as if it had not been stopped.
TEST_F(Script, StopsARunThatGoesOn)
{
  const std::string script =
      "import numpy as np\n"
      "def step(simulation):\n"
      "    v = simulation.particles['velocity'] * 0.999\n"
      "    simulation.particles['velocity'] = v\n"
      "    if simulation.step == 30 STOPS:\n"
      "        simulation.stop('enough')\n"
      "def end(simulation):\n"
      "    print('end', simulation.step)\n";
  const auto with = [&](const std::string& stops) { return std::regex_replace(script, std::regex("STOPS"), stops); };
  const Outcome whole = run(with("and False"), "whole");
  ASSERT_EQ(whole.code, 0) << whole.err;
  const Outcome stopped = run(with("and not simulation.history['time'] > 1"), "out");
  EXPECT_EQ(stopped.code, 4) << stopped.err;
  EXPECT_EQ(stopped.out, "end 30\n");
  EXPECT_THAT(stopped.err, HasSubstr("stopped by its script: enough before step 31"));
  const Outcome on = talus("run --resume out --quiet");
  ASSERT_EQ(on.code, 0) << on.err;
  expect_same("out", "whole");
}

/// What a script does to velocities is work of loads, and the balances close.
TEST_F(Script, SetsVelocitiesAndBalancesClose)
{
  const Outcome outcome = run(R"py(
def start(simulation):
    simulation.particles["velocity"] = [0, 0]

def step(simulation):
    if simulation.step == 10:
        simulation.bodies["block"]["velocity"] = simulation.particles["velocity"] + [1, 0]
)py",
                              "out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(without_losses(outcome.err), "");
  const HistoryTable table = history("out");
  EXPECT_EQ(first(table, "kinetic"), 0);
  const Real mass = first(table, "mass");
  const std::span<const Real> momentum = *table["momentum_x"];
  EXPECT_NEAR(*std::ranges::max_element(momentum), mass, 0.3 * mass);  // the fixed base takes some until the next row
  EXPECT_NEAR(last(table, "load_work"), 0.5 * mass, 0.1 * mass);
  EXPECT_LT(std::abs(last(table, "energy_defect")), 0.01 * 0.5 * mass);
}

TEST_F(Script, RefusesWhatWouldBreakTheState)
{
  const Outcome outcome = run(R"py(
import numpy as np

def raises(error, text, call):
    try:
        call()
    except error as e:
        assert text in str(e), e
    else:
        raise AssertionError(text)

old = []

def start(simulation):
    old.append(simulation)

def step(simulation):
    p = simulation.particles
    raises(TypeError, "only \"velocity\" can", lambda: p.__setitem__("stress", 0))
    raises(ValueError, "velocity[0, 0] is nan", lambda: p.__setitem__("velocity", np.nan))
    raises(ValueError, "", lambda: p.__setitem__("velocity", [1, 2, 3]))
    raises(ValueError, "read-only", lambda: p["velocity"].__setitem__(0, 0))
    raises(ValueError, "", lambda: p["velocity"].setflags(write=True))
    raises(KeyError, "particles have no \"speed\"; they have id", lambda: p["speed"])
    raises(KeyError, "nodes have no \"speed\"", lambda: simulation.nodes["speed"])

def end(simulation):
    raises(ValueError, "velocities can be set in step", lambda: simulation.particles.__setitem__("velocity", 0))
)py",
                              "out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

TEST_F(Script, SeesNothingBetweenCalls)
{
  const Outcome outcome = run(R"py(
import threading
import time

def look(simulation):
    try:
        while True:  # steps take most of the time
            simulation.time
            time.sleep(1e-4)
    except RuntimeError as error:
        print(error)

thread = None

def start(simulation):
    global thread
    thread = threading.Thread(target=look, args=[simulation])
    thread.start()

def end(simulation):
    thread.join()
)py",
                              "out");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out + outcome.err, HasSubstr("only while the run calls the script"));
}

TEST_F(Script, IsForOneRank)
{
  write("out.py", "def step(simulation): pass\n");
  const Outcome outcome = talus("run scene.yaml --script out.py --out out", launcher_of(2));
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("run it without mpirun"));
}

/// As on a machine without Python's library: the plugin cannot be loaded.
TEST_F(Script, NamesWhatIsMissing)
{
  std::filesystem::copy_file(TALUS_BINARY, folder_ / "talus");
  write("out.py", "def step(simulation): pass\n");
  const std::string command = "cd '" + folder_.path().string() +
                              "' && ./talus run scene.yaml --quiet --script out.py --out out 2>err.txt; test $? = 3 && " +
                              "./talus run scene.yaml --quiet --out plain";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_THAT(read("err.txt"),
              HasSubstr("libtalus_python.so, the part of the program that runs scripts and material laws in Python (on Debian it needs"));
}

TEST_F(Script, AddsColumnsToTheHistory)
{
  const std::string script = R"py(
columns = {"fastest": "m/s", "nothing": "-"}

def history(simulation):
    v = simulation.particles["velocity"]
    return {"fastest": (v ** 2).sum(axis=1).max() ** 0.5, "nothing": None}
)py";
  const Outcome outcome = run(script, "out", "--until 30");
  ASSERT_EQ(outcome.code, 4) << outcome.err;
  const Outcome on = talus("run --resume out --quiet");
  ASSERT_EQ(on.code, 0) << on.err;
  const Outcome whole = run(script, "whole");
  ASSERT_EQ(whole.code, 0) << whole.err;
  expect_same("out", "whole");
  const HistoryTable table = history("out");
  EXPECT_NEAR(first(table, "fastest"), std::sqrt(5.0), 1e-12);
  EXPECT_EQ(table.columns.back(), (CsvColumn{"nothing", ""}));
  EXPECT_TRUE(std::isnan(last(table, "nothing")));

  write("out.py", "def step(simulation): pass\n");
  std::filesystem::remove(newest("out"));
  const Outcome other = talus("run --resume out --quiet");
  EXPECT_EQ(other.code, 3);
  EXPECT_THAT(other.err, HasSubstr("history.csv"));
}

TEST_F(Script, NamesAColumnWithoutValue)
{
  const Outcome outcome = run("columns = {'a': 'm'}\ndef history(simulation):\n    return {'b': 1}\n", "out");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("history() did not return a dictionary with a value of \"a\""));
  const Outcome none = run("columns = {'a': 'm'}\ndef history(simulation):\n    return {'a': 'high'}\n", "none");
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, HasSubstr("none.py"));
}

}  // namespace
}  // namespace talus::script_test
