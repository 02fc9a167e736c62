"""A rigid block floats on water: how deep, beside Archimedes; still water without it, and a deformable block, for comparison."""
import numpy as np

import lab as tools

CASE = "floating_block"
SIZES = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # m: 4, 8 and 16 cells over the immersed depth
STILL = {0.1: "quick", 0.05: "full"}
LAST = 1.0  # s, at the end, over which is averaged


def start(lab, scene, size):
    """Starts a run of a scene with cells of a size."""
    return lab.run(f"{CASE}/{scene}.yaml", f"{scene}_{size:.3g}", {"mesh.size": size})


def exact_depth(data):
    """Depth of the lower side of the block below the water level [m]."""
    return data["height of the block [m]"] * data["density of the block [kg/m^3]"] / data["density of the water [kg/m^3]"]


def depth(middle, volume, data):
    """Depth of the lower side [m] of a block with its middle there, in so much water [m^2]: the level is where water and block fill the tank."""
    low, tank, block = middle - data["height of the block [m]"] / 2, data["width of the tank [m]"], data["width of the block [m]"]
    return (volume / tank - low) / (1 - block / tank)


def water(run, frame=-1):
    """Volume of the water in a particle file [m^2], as it is compressed then."""
    return float(run.frames[frame].of("water")["volume"].sum())


def last(history, column):
    """Mean of a column over the last second."""
    return float(history[column][history["time"] >= history["time"][-1] - LAST].mean())


def drift(history, column):
    """Mean change of a column per second over the last second."""
    after = history["time"] >= history["time"][-1] - LAST
    return float(np.polyfit(history["time"][after], history[column][after], 1)[0])


def judge(size, run, data):
    """Depth, drift, force and tilt of a rigid block."""
    exact, history = exact_depth(data), run.history
    weight = data["density of the block [kg/m^3]"] * data["width of the block [m]"] * data["height of the block [m]"] * data["gravity [m/s^2]"]
    found = depth(last(history, "rigid_block_y"), water(run), data) / exact
    sinks = -drift(history, "rigid_block_y") / (1 - data["width of the block [m]"] / data["width of the tank [m]"]) / exact
    tilt = np.degrees(np.sum(history["rigid_block_wz"][1:] * np.diff(history["time"])))
    name = f"cells of {size:.3g} m"
    return [tools.Result(CASE, f"immersed depth over that of Archimedes, {name}", "-", found, "within", data["slack"], 1.0, data["source"], run),
            tools.Result(CASE, f"change of this depth per second at the end, {name}", "1/s", sinks, "reported", None, 0.0, data["source"], run),
            tools.Result(CASE, f"force of the water over the weight, {name}", "-", last(history, "rigid_block_fy") / weight, "within", data["slack"], 1.0,
                         data["force source"], run),
            tools.Result(CASE, f"tilt at the end, {name}", "degrees", float(tilt), "reported", None, 0.0, data["source"], run)]


def judge_still(size, run, data):
    """How far the centre of still water falls per second, over its height."""
    return tools.Result(CASE, f"fall of the centre of still water per second over its height, cells of {size:.3g} m", "1/s",
                        -drift(run.history, "centre_y") / float(run.history["centre_y"][0]), "reported", None, 0.0, data["still source"], run)


def judge_elastic(size, run, data):
    """Depth of a deformable block and its change."""
    exact = exact_depth(data)
    sinks = -drift(run.history, "middle_y") / (1 - data["width of the block [m]"] / data["width of the tank [m]"]) / exact
    return [tools.Result(CASE, f"immersed depth of a deformable block over that of Archimedes, cells of {size:.3g} m", "-",
                         depth(last(run.history, "middle_y"), water(run), data) / exact, "reported", None, 1.0, data["source"], run),
            tools.Result(CASE, f"change of this depth per second at the end, deformable, cells of {size:.3g} m", "1/s", sinks, "reported", None, 0.0, data["source"], run)]


def draw(figure, runs, data):
    """Immersed depth over time."""
    axis = figure.subplots()
    axis.axhline(1, color="k", label="Archimedes")
    for size, run in runs.items():
        axis.plot(run.history["time"], depth(run.history["rigid_block_y"], water(run), data) / exact_depth(data), label=f"talus, cells of {size:.3g} m")
    axis.set(xlabel="time [s]", ylabel="immersed depth over that of Archimedes")
    axis.legend()


def evaluate(lab):
    """Results of rigid blocks, still water and, at full level, a deformable block."""
    data = tools.reference(CASE)
    runs = {size: start(lab, "scene", size) for size, level in SIZES.items() if lab.level in ("full", level)}
    still = {size: start(lab, "scene_still", size) for size, level in STILL.items() if lab.level in ("full", level)}
    elastic = {size: start(lab, "scene_elastic", size) for size in (0.1, 0.05) if lab.level == "full"}
    results = [result for size, run in runs.items() for result in judge(size, run, data)]
    results += [judge_still(size, run, data) for size, run in still.items()]
    results += [result for size, run in elastic.items() for result in judge_elastic(size, run, data)]
    lab.figure(CASE, "verification_floating_block", lambda figure: draw(figure, runs, data), caption="Immersed depth of a rigid block that floats.")
    return results
