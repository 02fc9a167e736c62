"""Drained compression of a block of clay in plane strain, beside the law of one point and the critical state."""
import numpy as np

import lab as tools

CASE = "clay_block"
SIZES = {0.125: "quick", 0.0625: "full"}  # m: 8 and 16 cells over the side of the block
LAYER = {0.25: "quick", 0.125: "quick", 0.0625: "full"}  # m: 4, 8 and 16 cells over the depth of the layer
LEFT = {0.0: "quick", -0.03: "full", -0.06: "full"}  # m, left end of the room of the layer
PLACES = {0.0: "quick", 0.03: "full", 0.06: "full"}  # m, by which the right end of the room moves: gmsh then makes other meshes
STEPS = 20000


def path(data, last):
    """The law of one point: axial strain (logarithmic, positive in compression), stresses xx, yy, zz [Pa, tension positive], log of volume.

    Kirchhoff stress t = J s, logarithmic strains, associated flow of f = q^2 / M^2 + p (p - pc); s_yy falls to -`last` at constant s_xx with e_zz = 0.
    """
    own, start = data["material"], data["start [Pa]"]
    stress, strain, pc = np.full(3, -start), np.zeros(3), own["preconsolidation_pressure"]
    rows, ones = [], np.ones(3)
    step = np.array([0, -(last - start) / STEPS, 0])
    for _ in range(STEPS + 1):
        rows.append([-strain[1], *stress, strain.sum()])
        volume = np.exp(strain.sum())
        kirchhoff = volume * stress
        p = -kirchhoff.mean()
        s = kirchhoff + p
        tangent = 2 * own["shear_modulus"] * (np.eye(3) - 1 / 3) + (p + own["reference_pressure"]) / own["swelling_index"]
        if 1.5 * s @ s / own["critical_state_slope"] ** 2 + p * (p - pc) >= -1e-6 * pc**2:
            normal = 3 * s / own["critical_state_slope"] ** 2 - (2 * p - pc) / 3
            hardening = p * pc * (2 * p - pc) / (own["compression_index"] - own["swelling_index"])
            flow = tangent @ normal
            multiplier = flow / (normal @ flow + hardening)
            plastic = tangent - np.outer(flow, multiplier)
        else:
            multiplier, plastic = np.zeros(3), tangent
        cauchy = plastic / volume - np.outer(stress, ones)
        change = np.append(np.linalg.solve(cauchy[:2, :2], step[:2]), 0)
        if multiplier @ change > 0 or not multiplier.any():
            pc += pc / (own["compression_index"] - own["swelling_index"]) * (2 * p - pc) * max(multiplier @ change, 0)
        strain, stress = strain + change, stress + cauchy @ change
    return np.array(rows).T


def critical(data):
    """Pressure on the upper side at the critical state [Pa]."""
    slope, root = data["material"]["critical_state_slope"], np.sqrt(3)
    return float(data["start [Pa]"] * (root + slope) / (root - slope))


def invariants(stress):
    """p and q [Pa] of stresses by their components, the shear stress in the plane last if there is one."""
    normal = stress[:3]
    p = -np.mean(normal, axis=0)
    shear = 3 * stress[3] ** 2 if len(stress) > 3 else 0
    return p, np.sqrt(1.5 * np.sum((normal + p) ** 2, axis=0) + shear)


def measured(run):
    """Of each frame: axial strain by the slope of the displacement over the height, mean stresses xx, yy, zz, xy [Pa], log of volume,
    deviation of the axial stress between particles over the mean."""
    rows, first = [], run.frames[0]  # at rest
    height = first["position"][:, 1]
    for frame in run.frames:
        weight = frame["volume"] / frame["volume"].sum()
        stress = weight @ frame["stress"][:, :4]
        slope = np.polyfit(height, frame["position"][:, 1] - height, 1)[0]
        spread = np.sqrt(weight @ (frame["stress"][:, 1] - stress[1]) ** 2) / -stress[1]
        rows.append([-np.log1p(slope), *stress, np.log(frame["volume"].sum() / first["volume"].sum()), spread])
    return np.array(rows).T


def at(strain, axial, values):
    """A value at a strain, by the first time that it is reached; not a number if it is not."""
    if not np.any(axial >= strain):
        return float("nan")
    last = int(np.argmax(axial >= strain))
    return float(np.interp(strain, axial[last - 1:last + 1], values[last - 1:last + 1]))


def named(size, place):
    """The mesh, in the names of results."""
    return f"cells of {round(size, 4):g} m" + ("" if place == 0 else f", room wider by {place} m")


def judge(size, place, run, exact, data):
    """q and the change of volume at equal axial strain."""
    axial, *stress, volume, spread = measured(run)
    q, law_q = invariants(np.array(stress))[1], invariants(exact[1:4])[1]
    where, results = named(size, place), []
    for strain in data["strains"]:
        results += [tools.Result(CASE, f"q at an axial strain of {strain}, {where}", "Pa", at(strain, axial, q), "within", data["slack"], at(strain, exact[0], law_q), data["source"], run),
                    tools.Result(CASE, f"volume strain at an axial strain of {strain}, {where}", "-", at(strain, axial, volume), "within", data["slack"],
                                 at(strain, exact[0], exact[4]), data["source"], run)]
    return results + [
        tools.Result(CASE, f"mean stress on the right side's normal at an axial strain of {data['strains'][-1]}, {where}", "Pa", -at(data["strains"][-1], axial, stress[0]), "reported",
                     None, data["start [Pa]"], "the pressure on the right side", run),
        tools.Result(CASE, f"spread of the axial stress at an axial strain of {data['strains'][-1]}, rms over the mean, {where}", "-", at(data["strains"][-1], axial, spread), "reported",
                     None, 0.0, "", run)]


def sheared(run, frame, data):
    """Mean stresses xx, yy, zz, xy [Pa] of the clay that shears, in the middle of the layer."""
    own = data["layer"]
    x, y = frame["position"][:, 0], frame["position"][:, 1]
    weight = frame["volume"] * ((x > own["middle [m]"][0]) & (x < own["middle [m]"][1]) & (y < own["shearing [m]"]))
    return weight @ frame["stress"][:, :4] / weight.sum()


def judge_layer(size, place, run, data):
    """Friction and q / p of the shearing clay, means over the steady time; frames are 0.05 s apart."""
    own = data["layer"]
    begin, end = (round(time / 0.05) for time in own["steady [s]"])
    stresses = [sheared(run, run.frames[number], data) for number in range(begin, end + 1)]
    where = f"cells of {size:g} m" + ("" if place == 0 else f", mesh from {place} m")
    p, q = np.array([invariants(stress) for stress in stresses]).T
    return [tools.Result(CASE, f"layer: angle of shear over normal stress, {where}", "deg", float(np.mean([np.degrees(np.arctan2(stress[3], -stress[1])) for stress in stresses])),
                         "near", own["tolerance [deg]"], float(np.degrees(np.arctan(data["material"]["critical_state_slope"] / np.sqrt(3)))), own["source"], run),
            tools.Result(CASE, f"layer: q / p, {where}", "-", float(np.mean(q / p)), "within", data["slack"], data["material"]["critical_state_slope"], data["critical source"], run)]


def draw(figure, runs, layer, exact, data):
    """q and change of volume over the axial strain of the block; q / p of the layer over time."""
    left, centre, right = figure.subplots(1, 3)
    law_q, shown = invariants(exact[1:4])[1], exact[0] < 0.13
    left.plot(exact[0][shown], law_q[shown] / 1e3, "k", label="law of one point")
    centre.plot(exact[0][shown], 100 * exact[4][shown], "k")
    for colour, (size, run) in enumerate(runs.items()):
        axial, *stress, volume, _ = measured(run)
        q, kept = invariants(np.array(stress))[1], axial < 0.13
        left.plot(axial[kept], q[kept] / 1e3, "o", ms=3, fillstyle="none", color=f"C{colour}", label=f"cells of {round(size, 4):g} m")
        centre.plot(axial[kept], 100 * volume[kept], "o", ms=3, fillstyle="none", color=f"C{colour}")
    right.axhline(data["material"]["critical_state_slope"], color="k", label="critical state")
    for colour, (size, run) in enumerate(layer.items()):
        p, q = np.array([invariants(sheared(run, frame, data)) for frame in run.frames[1:]]).T
        right.plot(0.05 * np.arange(1, len(p) + 1), q / p, "o-", ms=3, lw=0.6, color=f"C{colour}", label=f"cells of {size:g} m")
    left.set(xlabel="axial strain of the block", ylabel="q [kPa]")
    centre.set(xlabel="axial strain of the block", ylabel="volume strain [%]")
    right.set(xlabel="time [s]", ylabel="q / p of the layer", ylim=(0.5, 1.1))
    left.legend(fontsize=7)
    right.legend(fontsize=7)


def meshes(lab, sizes, places, once=()):
    """The meshes of this level, (size, place); sizes of `once` at the first place only."""
    return [(size, place) for size in sizes for place in places if {sizes[size], places[place]} == {"quick"} or lab.level == "full" and (place == 0 or size not in once)]


def evaluate(lab):
    """Results of the block and of the layer, on all meshes of this level."""
    data = tools.reference(CASE)
    exact = path(data, 0.9 * critical(data))
    runs = tools.ends({(size, place): lab.run(f"{CASE}/scene.yaml", tools.label(f"{size}_{place}"), {"mesh.size": size, "mesh.regions[0].shape.high": [1.5 + place, 1.1]})
                       for size, place in meshes(lab, SIZES, PLACES)})
    layer = tools.ends({(size, place): lab.run(f"{CASE}/layer.yaml", tools.label(f"layer_{size}_{-place}"), {"mesh.size": size, "mesh.regions[0].shape.low": [place, 0]})
                        for size, place in meshes(lab, LAYER, LEFT, [0.0625])})
    first = {size: run for (size, place), run in runs.items() if place == 0}
    lab.figure(CASE, "verification_clay_block", lambda figure: draw(figure, first, {size: run for (size, place), run in layer.items() if place == 0}, exact, data),
               size=(9, 3.2), caption="Clay: a block compressed at constant lateral stress beside the law of one point, and a layer that slides at the critical state.")
    results = [result for (size, place), run in runs.items() for result in judge(size, place, run, exact, data)]
    return results + [result for (size, place), run in layer.items() for result in judge_layer(size, place, run, data)]
