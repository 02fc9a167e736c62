"""A thin rigid sheet with material on both sides: the net force of water at rest, and of sand through which it is pushed."""
import numpy as np

import lab as tools

CASE = "sheet"
SIZES = {0.1: "quick", 0.05: "full", 0.025: "full"}  # m: 10, 20 and 40 cells over the depth of the sand
TOPS = {0.0: "quick", 0.03: "full", 0.06: "full"}  # m by which the room is higher: gmsh then makes other triangles
FINEST = 0.025  # m, on one mesh: it takes ten minutes
WATER_SIZES = {0.1: "quick", 0.05: "full"}
BLADE_SIZES = {0.1: "quick", 0.05: "quick"}
AROUND_EDGE = 2  # cells above the edge of the blade, below which material may have gone around it
PUSHED = 0.8  # s, from which the sheet has its full velocity and the forces are averaged
STILL = 1.0  # s, from which the water has its weight


def start(lab, scene, size, higher, height):
    """Starts a run."""
    high = {"scene": [6, height + higher], "scene_water": [4, height + higher]}[scene]
    return lab.run(f"{CASE}/{scene}.yaml", tools.label(f"{scene}_{size}_{higher}"), {"mesh.size": size, "mesh.regions[0].shape.high": high})


def rankine(data):
    """Net force of sand on a smooth sheet that moves through it [N/m]."""
    passive = np.tan(np.radians(45 + data["friction angle [degrees]"] / 2))**2
    depth, cohesion = data["depth of the sand [m]"], data["cohesion [Pa]"]
    return ((passive - 1 / passive) * data["weight of the sand [N/m^3]"] * depth**2 / 2
            + 2 * cohesion * depth * (np.sqrt(passive) + np.sqrt(1 / passive)))


def hydrostatic(data):
    """Net force of water at rest [N/m]."""
    high, low = data["depths of the water [m]"]
    return data["weight of the water [N/m^3]"] * (high**2 - low**2) / 2


def mean_force(run, after):
    """Mean force along x on the sheet after a time [N/m]."""
    history = run.history
    return float(history["rigid_sheet_fx"][history["time"] > after].mean())


def passed(run, body, sheet, size, above=0.0):
    """Particles of a body above a height [m] that began a tenth of a cell or more from the plane of an upright sheet, and end on its other side by
    more than a quarter of a cell.  Nearer ones may cross the plane before the edge arrives."""
    last = run.frames[-1].of(body)
    begin = last["position"][:, 0] - last["displacement"][:, 0]
    at_begin, at_end = run.history[f"rigid_{sheet}_x"][[0, -1]]
    through = np.where(begin > at_begin, at_end - last["position"][:, 0], last["position"][:, 0] - at_end)
    return int(np.count_nonzero((np.abs(begin - at_begin) > size / 10) & (through > size / 4) & (last["position"][:, 1] > above)))


def opening(run, data):
    """How far the block opens at the height of its upper side [m]: between the two particles that were nearest to the blade there."""
    last = run.frames[-1].of("block")
    begin = last["position"] - last["displacement"]
    upper = begin[:, 1] > begin[:, 1].max() - 0.03
    side = begin[:, 0] > data["place of the blade [m]"]
    ends = [last["position"][upper & side, 0].min(), last["position"][upper & ~side, 0].max()]
    return float(ends[0] - ends[1])


def judge(size, higher, run, data):
    """Force and passing particles of the sheet in sand."""
    where = f"cells of {size:.3g} m, room higher by {higher:.3g} m"
    return [tools.Result(CASE, f"force of the sand, {where}", "N/m", -mean_force(run, PUSHED), "within", data["slack"], float(rankine(data)), data["source"], run),
            tools.Result(CASE, f"particles that passed through, {where}", "-", passed(run, "sand", "sheet", size), "at most", 0, 0, data["passing source"], run)]


def judge_water(size, higher, run, data):
    """Force of water."""
    where = f"cells of {size:.3g} m, tank higher by {higher:.3g} m"
    return tools.Result(CASE, f"net force of the water, {where}", "N/m", mean_force(run, STILL), "within", data["slack"], float(hydrostatic(data)),
                        data["water source"], run)


def judge_blade(size, run, data):
    """Opening, passing particles and energy of a block that a blade cuts."""
    where = f"cells of {size:.3g} m"
    return [tools.Result(CASE, f"opening of a cut block, {where}", "m", opening(run, data), "reported", None, None, "none", run),
            tools.Result(CASE, f"particles that passed through the blade, {where}", "-",
                         passed(run, "block", "blade", size, data["edge of the blade at the end [m]"] + AROUND_EDGE * size), "at most", 0, 0, data["passing source"], run)]


def draw_blade(figure, run, data):
    """The cut block."""
    axis = figure.subplots()
    last = run.frames[-1].of("block")
    dots = axis.scatter(*last["position"].T[:2], s=3, c=last["displacement"][:, 0], cmap="coolwarm", vmin=-0.3, vmax=0.3)
    edge = data["edge of the blade at the end [m]"]
    axis.plot([data["place of the blade [m]"]] * 2, [edge, edge + 1.1], "k", linewidth=1.5)
    axis.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    figure.colorbar(dots, label="displacement x [m]")


def draw(figure, runs, data):
    """Force over the way of the sheet."""
    axis = figure.subplots()
    axis.axhline(rankine(data) / 1000, color="k", label="Rankine, active and passive")
    for (size, higher), run in runs.items():
        if higher == 0.0:
            way = run.history["rigid_sheet_x"] - run.history["rigid_sheet_x"][0]
            axis.plot(1000 * way, -run.history["rigid_sheet_fx"] / 1000, label=f"talus, cells of {size:.3g} m")
    axis.set(xlabel="way of the sheet [mm]", ylabel="force of the sand on the sheet [kN/m]")
    axis.legend()


def evaluate(lab):
    """Results of sheets in sand and in water."""
    data = tools.reference(CASE)
    def levels(sizes):
        every = [(size, top) for size in sizes for top in TOPS if size != FINEST or top == 0.0]
        return [(size, top) for size, top in every if lab.level == "full" or {sizes[size], TOPS[top]} == {"quick"}]
    sand = {at: start(lab, "scene", *at, 1.6) for at in levels(SIZES)}
    water = {at: start(lab, "scene_water", *at, 2) for at in levels(WATER_SIZES)}
    blade = {size: lab.run(f"{CASE}/scene_blade.yaml", tools.label(f"blade_{size}"), {"mesh.size": size})
             for size, level in BLADE_SIZES.items() if level == "quick" or lab.level == "full"}
    results = [result for at, run in sand.items() for result in judge(*at, run, data)]
    results += [judge_water(*at, run, data) for at, run in water.items()]
    results += [result for size, run in blade.items() for result in judge_blade(size, run, data)]
    lab.figure(CASE, "verification_sheet_blade", lambda figure: draw_blade(figure, blade[0.05], data), caption="A block that a blade has cut halfway.")
    lab.figure(CASE, "verification_sheet", lambda figure: draw(figure, sand, data), caption="Force on a sheet that is pushed through sand.")
    return results
