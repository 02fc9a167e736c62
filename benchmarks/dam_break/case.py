"""Breaking dam on a dry floor without friction, beside the closed form of Ritter."""
import numpy as np

import lab as tools

CASE = "dam_break"
SIZES = {0.25: "quick", 0.125: "quick", 0.0625: "full"}  # m: 4, 8 and 16 cells over the depth
PLACES = {0.0: "quick", -0.03: "full", -0.06: "full"}  # m, by which the left end of the room moves: gmsh then makes other meshes
STRIP = 0.25  # of the depth before, over which depths are averaged
chute = tools.module("granular_chute")


def depth_error(run, number, closed, time):
    """Root mean square of the difference of depths over the depth before, over the fan of the closed form."""
    x, y = chute.depths(run.frames[number], STRIP * closed.depth)
    back, front = closed.ends(time)
    inside = (x > back) & (x < front)
    return tools.rms((y - closed.at(x, time))[inside]) / closed.depth


def named(size, place):
    """The mesh, in the names of results."""
    return f"cells of {size:g} m" + ("" if place == 0 else f", mesh from {-7 + place} m")


def judge(size, place, run, closed, data):
    """Depth at all times (judged at the last), and the front."""
    results, last = [], len(data["times [s]"])
    for number, time in enumerate(data["times [s]"], 1):
        asked = ("at most", data["slack"]) if number == last else ("reported", None)
        results.append(tools.Result(CASE, f"depth, rms over the depth before at {time} s, {named(size, place)}", "-", depth_error(run, number, closed, time), *asked, 0.0,
                                    data["source"], run))
    x, y = chute.depths(run.last_frame(), STRIP * closed.depth)
    return results + [
        tools.Result(CASE, f"x where a tenth as deep as before, {named(size, place)}", "m", chute.farthest(x, y, closed.depth / 10), "within",
                     closed.shallowness(time), closed.place(closed.depth / 10, time), data["front source"], run),
        tools.Result(CASE, f"front that 0.1 % of the water has passed, {named(size, place)}", "m", float(run.history["front"][-1]), "reported", None,
                     passed(closed, time, 0.001 * 7 * closed.depth), data["source"], run)]


def passed(closed, time, volume):
    """x [m] beyond which the closed form has this volume [m^2]: h = a (f - x)^2 with the front f has a (f - x)^3 / 3 beyond x."""
    front = closed.ends(time)[1]
    return float(front - np.cbrt(3 * volume * 9 * closed.stiffness * time**2))


def draw(figure, runs, closed, data):
    """Depth over place at all times, for the largest and the smallest cells."""
    axis = figure.subplots()
    for colour, time in enumerate(data["times [s]"]):
        fine = np.linspace(-7, 13, 500)
        axis.plot(fine, closed.at(fine, time), color=f"C{colour}", label=f"Ritter, {time:g} s")
        for mark, size in zip(("+", "o"), (max(runs), min(runs))):
            x, y = chute.depths(runs[size].frames[colour + 1], STRIP * closed.depth)
            axis.plot(x, y, mark, ms=3, color=f"C{colour}", fillstyle="none", label=f"talus, cells of {size:g} m" if colour == 0 else None)
    axis.set(xlabel="x [m]", ylabel="depth [m]", ylim=(-0.02, 1.1))
    axis.legend(fontsize=7)


def evaluate(lab):
    """Results on all meshes of this level."""
    data = tools.reference(CASE)
    closed = chute.DamBreak(data, 1.0)
    runs = tools.ends({(size, place): lab.run(f"{CASE}/scene.yaml", tools.label(f"{size}_{-place}"), {"mesh.size": size, "mesh.regions[0].shape.low": [-7 + place, 0]})
                       for size in SIZES for place in PLACES if lab.level == "full" or {SIZES[size], PLACES[place]} == {"quick"}})
    sizes = sorted((size for size, place in runs if place == 0), reverse=True)
    lab.convergence(CASE, "depth at the last time", sizes, [depth_error(runs[size, 0.0], len(data["times [s]"]), closed, data["times [s]"][-1]) for size in sizes])
    lab.figure(CASE, "verification_ritter", lambda figure: draw(figure, {size: runs[size, 0.0] for size in sizes}, closed, data),
               caption="Breaking dam on a dry floor without friction: depth beside the closed form of Ritter.")
    return [result for (size, place), run in runs.items() for result in judge(size, place, run, closed, data)]
