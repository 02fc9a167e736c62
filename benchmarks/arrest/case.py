"""A solid that flows above its yield stress: a layer down an incline that flows and stops, and a slump, beside closed forms and the regularised fluid."""
import numpy as np

import lab as tools

CASE = "arrest"
LAYER = {0.25: "quick", 0.125: "quick", 0.0625: "full"}  # m: 4, 8 and 16 cells over the depth of 1 m
SLUMP = {0.01: "quick", 0.007: "full", 0.005: "full"}  # m: 7, 10 and 14 cells over the final height
PLACES = {0.0: "quick", -0.03: "full", -0.06: "full"}  # of the depth or of the height, by which the far end of the room moves: gmsh then makes other meshes
STRIP = 0.02  # m, over which the height of the slump is averaged
EVERY = {"layer": 0.05, "slump": 0.5}  # s between frames
fluids = tools.module("fluid_layer")
chute = tools.module("granular_chute")


def law(fluid, regularised=None):
    """Settings of the first material: the new law has them in the scene but for `fluid`; with `regularised` [s] the fluid of Papanastasiou instead."""
    if regularised is None:
        return {f"materials[0].{key}": value for key, value in fluid.items()}
    return {"materials[0]": {"name": "mud", "law": "herschel_bulkley", "regularisation": regularised, **fluid}}


def pull(data):
    """Weight of a unit of volume along the incline [N/m^3]."""
    return data["density [kg/m^3]"] * data["layer"]["gravity [m/s^2]"] * np.sin(np.radians(data["layer"]["angle [deg]"]))


def moved(run, data):
    """Displacement along the incline of the surface in the middle of the layer at each frame [m]."""
    low, high = data["layer"]["middle [m]"]
    places = []
    for frame in run.frames:
        start = frame["position"] - frame["displacement"]
        near = (start[:, 0] > low) & (start[:, 0] < high) & (start[:, 1] > 0.9 * data["depth [m]"])
        places.append(float(np.average(frame["displacement"][near, 0], weights=frame["volume"][near])))
    return EVERY["layer"] * np.arange(len(places)), np.array(places)


def speed_at_rest(run, data):
    """Speed of the surface in the time in which the layer should rest [m/s]: a straight line through its displacements, which vibrate a little."""
    time, place = moved(run, data)
    begin, end = data["layer"]["rests [s]"]
    resting = (time > begin - 1e-9) & (time < end + 1e-9)
    return float(np.polyfit(time[resting], place[resting], 1)[0])


def judge_layer(name, runs, data):
    """Velocity and plug while the layer flows, and what is left of the speed after it has stopped."""
    own, depth, results = data["layer"], data["depth [m]"], []
    fluid = own["fluids"][name]
    closed = {**data, "layer": own}
    plug = fluid["yield_stress"] / pull(data)
    top = float(fluids.ideal(np.array([depth]), fluid, closed)[0])
    for (size, place), run in runs.items():
        seen, where = fluids.middle(run, own["flows [s]"], own["middle [m]"]), fluids.named(size, place)
        asked = ("at most", own["slack"]) if size < 0.1 else ("reported", None)
        within = ("within", own["slack"]) if size < 0.1 else ("reported", None)
        results += [
            tools.Result(CASE, f"{name}: velocity, rms over the largest, {where}", "-",
                         fluids.error(run, own["flows [s]"], own["middle [m]"], lambda y: fluids.ideal(y, fluid, closed)), *asked, 0.0, own["source"], run),
            tools.Result(CASE, f"{name}: thickness of the plug by stress, {where}", "m",
                         depth - fluids.height_where(*fluids.profile(seen, seen["stress"][:, 3], depth), fluid["yield_stress"]), *within, plug, own["plug source"], run),
            tools.Result(CASE, f"{name}: speed after the stop over that before, {where}", "-", abs(speed_at_rest(run, data)) / top, "at most", own["rest slack"], 0.0,
                         own["rest source"], run)]
    return results


def judge_creep(name, run, data, size):
    """The same layer of the regularised fluid goes on."""
    own, fluid = data["layer"], data["layer"]["fluids"][name]
    top = float(fluids.ideal(np.array([data["depth [m]"]]), fluid, data)[0])
    creep = own["left of the pull"] * pull(data) * data["depth [m]"] ** 2 / (2 * (fluid["consistency"] + fluid["yield_stress"] * own["regularisation [s]"]))
    return tools.Result(CASE, f"{name}: speed after the stop over that before, herschel_bulkley, {fluids.named(size, 0)}", "-", speed_at_rest(run, data) / top, "reported",
                        None, creep / top, own["creep source"], run)


class Slump:
    """Half of a slump of a given volume on a rough floor at the limit of equilibrium. `order` 1: with the longitudinal stress, 0: shallow."""

    def __init__(self, data, order):
        own = data["slump"]
        self.scale = own["yield_stress"] / (data["density [kg/m^3]"] * own["gravity [m/s^2]"])
        self.edge = np.pi * self.scale * order  # height of the front
        volume, low, high = own["half width [m]"] * own["height [m]"], self.edge, 10 * own["height [m]"]
        for _ in range(200):
            self.top = (low + high) / 2
            low, high = (low, self.top) if self.volume() > volume else (self.top, high)
        self.length = self.top**2 / (2 * self.scale) - self.edge * self.top / (2 * self.scale)

    def volume(self):
        """Of the half with the height `top` at its middle [m^2]."""
        top, edge = self.top, self.edge
        return (top**3 - edge**3) / (3 * self.scale) - edge * (top**2 - edge**2) / (4 * self.scale)

    def at(self, x):
        """Height [m]."""
        return np.where(x < self.length, self.edge / 2 + np.sqrt(self.edge**2 / 4 + 2 * self.scale * np.clip(self.length - x, 0, None)), 0)

    def passed(self, share):
        """x [m] beyond which the share of the volume lies."""
        x = np.linspace(0, self.length, 20001)
        beyond = np.cumsum(self.at(x)[::-1])[::-1]
        return float(x[np.nonzero(beyond / beyond[0] > share)[0][-1]])


def slump_error(run, closed):
    """Root mean square of the difference of heights over the height of the middle, behind the front of the closed form."""
    x, y = chute.depths(run.last_frame(), STRIP)
    inside = (x > 0) & (x < closed.length)
    return tools.rms((y - closed.at(x))[inside]) / closed.top


def top_of(run):
    """Height of the middle [m], over the two strips beside it."""
    x, y = chute.depths(run.last_frame(), STRIP)
    return float(np.mean(y[(x > 0) & (x < 2 * STRIP)]))


def last_pace(run, seconds=1.0):
    """Mean speed of the front in the last time of the run [m/s]."""
    time, front = run.history["time"], run.history["front"]
    return float((front[-1] - np.interp(time[-1] - seconds, time, front)) / seconds)


def stretched(run, closed):
    """Mean difference of the stresses along and normal to the floor between a quarter and three quarters of the length [Pa]."""
    frame = run.last_frame()
    inside = (frame["position"][:, 0] > closed.length / 4) & (frame["position"][:, 0] < 0.75 * closed.length)
    return float(np.average(frame["stress"][inside, 0] - frame["stress"][inside, 1], weights=frame["volume"][inside]))


def judge_slump(where, run, closed, shallow, data, asked):
    """Shape at the end, and how fast it still spreads."""
    own = data["slump"]
    within = ("within", own["slack"]) if asked else ("reported", None)
    at_most = ("at most", own["slack"]) if asked else ("reported", None)
    return [
        tools.Result(CASE, f"slump: x that 1 % of the volume has passed, {where}", "m", float(run.history["front"][-1]), *within, closed.passed(0.01), own["source"], run),
        tools.Result(CASE, f"slump: height of the middle, {where}", "m", top_of(run), *within, float(np.mean(closed.at(np.array([STRIP / 2, 1.5 * STRIP])))), own["source"], run),
        tools.Result(CASE, f"slump: height, rms over that of the middle, {where}", "-", slump_error(run, closed), *at_most, 0.0, own["source"], run),
        tools.Result(CASE, f"slump: height beside the shallow slump, {where}", "-", slump_error(run, shallow), "reported", None, 0.0, own["shallow source"], run),
        tools.Result(CASE, f"slump: stress along the floor less that normal to it, over the yield stress, {where}", "-", stretched(run, closed) / own["yield_stress"], "reported",
                     None, np.pi / 2, own["stress source"], run),
        tools.Result(CASE, f"slump: speed of the front in the last second, {where}", "m/s", last_pace(run), "reported", None, 0.0, own["source"], run)]


def draw(figure, layers, creeping, slump, fluid, closed, shallow, data):
    """Velocity of the layers; displacement of the surface over time; the slump."""
    left, middle, right = figure.subplots(1, 3)
    own, depth = data["layer"], data["depth [m]"]
    y = np.linspace(0, depth, 200)
    for colour, (name, run) in enumerate(layers.items()):
        left.plot(fluids.ideal(y, own["fluids"][name], data), y, color=f"C{colour}", label=name)
        seen = fluids.middle(run, own["flows [s]"], own["middle [m]"])
        left.plot(seen["velocity"][::3, 0], seen["position"][::3, 1], ".", ms=2, color=f"C{colour}")
    left.set(xlabel=f"velocity at {own['flows [s]']} s [m/s]", ylabel="height [m]")
    for name, run, style in (("elastic_herschel_bulkley", layers["Bingham"], "-"), ("herschel_bulkley", creeping, "--")):
        middle.plot(*moved(run, data), style, color="C0" if style == "-" else "C3", label=name)
    middle.set(xlabel="time [s]", ylabel="displacement of the surface, Bingham [m]")
    x = np.linspace(0, closed.length, 400)
    right.plot(x, closed.at(x), "k", label="with longitudinal stress")
    right.plot([closed.length, closed.length], [0, closed.edge], "k")
    x = np.linspace(0, shallow.length, 400)
    right.plot(x, shallow.at(x), "k--", lw=0.8, label="shallow")
    for name, run, mark in (("elastic_herschel_bulkley", slump, "o"), ("herschel_bulkley", fluid, "x")):
        right.plot(*chute.depths(run.last_frame(), STRIP), mark, ms=3, fillstyle="none", color="C0" if mark == "o" else "C3", label=name)
    right.set(xlabel="x [m]", ylabel="height of the slump [m]", xlim=(0, None))
    for axis in (left, middle, right):
        axis.legend(fontsize=6)


def wanted(lab, sizes):
    """The meshes of this level, (size, place)."""
    return [(size, place) for size in sizes for place in PLACES if lab.level == "full" or {sizes[size], PLACES[place]} == {"quick"}]


def evaluate(lab):
    """Results of the layers and of the slump."""
    data = tools.reference(CASE)
    own, slump = data["layer"], data["slump"]
    closed, shallow = Slump(data, 1), Slump(data, 0)
    layers = {name: {(size, place): lab.run(f"{CASE}/layer.yaml", tools.label(f"{name}_{size}_{-place}"),
                                            {"mesh.size": size, "mesh.regions[0].shape.low": [place, 0], **law(fluid)}) for size, place in wanted(lab, LAYER)}
              for name, fluid in own["fluids"].items()}
    creeping = lab.run(f"{CASE}/layer.yaml", "regularised", {"mesh.size": 0.25, **law({"density": 1000, "bulk_modulus": 2e6, **own["fluids"]["Bingham"]},
                                                                                       own["regularisation [s]"])})
    slumps = {(size, place): lab.run(f"{CASE}/slump.yaml", tools.label(f"slump_{size}_{-place}"),
                                     {"mesh.size": size, "mesh.regions[0].shape.high": [0.6 - 0.1 * place, 0.12]}) for size, place in wanted(lab, SLUMP)}
    spreading = lab.run(f"{CASE}/slump.yaml", "slump_regularised", {"mesh.size": 0.01, **law({"density": 1000, "bulk_modulus": 1e5, "yield_stress": 50, "consistency": 10,
                                                                                              "flow_index": 1}, slump["regularisation [s]"])})
    layers, slumps = {name: tools.ends(runs) for name, runs in layers.items()}, tools.ends(slumps)
    results = [result for name, runs in layers.items() for result in judge_layer(name, runs, data)]
    results.append(judge_creep("Bingham", creeping, data, 0.25))
    for (size, place), run in slumps.items():
        results += judge_slump(fluids.named(size, 0) + ("" if place == 0 else f", room to {0.6 - 0.1 * place:g} m"), run, closed, shallow, data, size < 0.006)
    results += judge_slump(f"herschel_bulkley, {fluids.named(0.01, 0)}", spreading, closed, shallow, data, False)
    for name, runs in layers.items():
        sizes = sorted((size for size, place in runs if place == 0), reverse=True)
        lab.convergence(CASE, f"{name}: velocity of the layer", sizes,
                        [fluids.error(runs[size, 0.0], own["flows [s]"], own["middle [m]"], lambda y, name=name: fluids.ideal(y, own["fluids"][name], data)) for size in sizes])
    sizes = sorted((size for size, place in slumps if place == 0), reverse=True)
    lab.convergence(CASE, "height of the slump", sizes, [slump_error(slumps[size, 0.0], closed) for size in sizes])
    lab.figure(CASE, "verification_arrest",
               lambda figure: draw(figure, {name: runs[min(runs)[0], 0.0] for name, runs in layers.items()}, creeping, slumps[min(slumps)[0], 0.0], spreading, closed, shallow,
                                   data),
               size=(9, 3.2), caption="Layers down an incline while they flow; the surface of one that stops; a slump at its end.")
    return results
