"""Cantilevers in large deflection: a slender one and the same turned with its mesh, a thick one in two and three dimensions; tips against finite elements."""
import numpy as np

import fields
import lab as tools

CASE = "cantilever"
SIZES = {"quick": [0.5, 0.25], "full": [0.5, 0.25, 0.125]}
SHORT = {"quick": [0.25, 0.125], "full": [0.25, 0.125, 0.0625]}  # of the thick beam
SOLID = {"quick": [0.35], "full": [0.35, 0.25]}  # of the thick beam in three dimensions
ANGLES = {"quick": [0, 30, 75], "full": [0, 15, 30, 45, 60, 75, 90]}  # degrees
OTHER = "projected, aflip"  # the method beside that of the scenes, which takes cells of 0.25 m over 4 s at full level only: they are dear
OTHER_SIZES = {"quick": [0.5], "full": [0.5, 0.25, 0.125]}
BENDING = ("umls, exact_force, aflip", "projected, extended, aflip")  # made for bodies that bend; beside the others, of the same sizes
OTHER_ANGLES = {"quick": [0, 30], "full": [0, 15, 30, 45, 60, 75, 90]}  # of cells of 0.25 m
FRAMES = 0.025  # s, between the frames of the thick beams
SWEPT = {"quick": [1, 0.7, 0.5, 0.35], "full": [1, 0.7, 0.5, 0.35, 0.25]}  # for tradeoff()


def first_minimum(history, before=1.0):
    """Time [s] and vertical displacement [m] of the tip at its first lowest place."""
    early = history["time"] < before
    lowest = int(np.argmin(history["tip_uy"][early]))
    return float(history["time"][lowest]), float(history["tip_uy"][lowest])


def history_error(history, curve, data):
    """Root mean square of the difference to the reference history over the first minimum."""
    return tools.rms(np.interp(curve["time"], history["time"], history["tip_uy"]) - curve["uy"]) / abs(data["first minimum [m]"])


def energy_change(run, gravity):
    """Largest change of kinetic, strain and potential energy together over the largest strain energy; not taken from the program's ledger."""
    history = run.history
    potential = history["mass"] * gravity * (history["centre_y"] - history["centre_y"][0])
    return float(np.max(np.abs(history["kinetic"] + history["strain"] + potential)) / np.max(history["strain"]))


def ledger_defect(run):
    """Largest defect that the program's own energy ledger shows, over the largest strain energy."""
    return float(np.max(np.abs(run.history["energy_defect"])) / np.max(run.history["strain"]))


def draw(figure, runs, curve):
    """Deflection of the tip over time."""
    axis = figure.subplots()
    for size, run in runs.items():
        axis.plot(run.history["time"], run.history["tip_uy"], label=f"talus, {size}")
    axis.plot(curve["time"], curve["uy"], "ko", markersize=4, fillstyle="none", label="finite elements")
    axis.set(xlabel="time [s]", ylabel="vertical displacement of the tip [m]")
    axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncol=2, fontsize=7)


def judge(name, size, run, curve, data):
    """Results of one run; only cells of 0.25 m and smaller (8 over the height) are judged."""
    judged = size <= 0.25
    time, lowest = first_minimum(run.history)
    reference, source = data["first minimum [m]"], f"{data['source']}; {data['published']}"
    return [
        tools.Result(CASE, f"first minimum of the tip, {name}", "m", lowest, "within" if judged else "reported", 0.015 if judged else None,
                     reference, source, run),
        tools.Result(CASE, f"time of the first minimum, {name}", "s", time, "within" if judged else "reported", 0.015 if judged else None,
                     data["time of first minimum [s]"], source, run),
        tools.Result(CASE, f"rms error of the tip over 4 s, {name}", "-", history_error(run.history, curve, data), "at most" if judged else "reported",
                     0.03 if judged else None, 0.0, source, run),
        tools.Result(CASE, f"change of energy, {name}", "-", energy_change(run, data["gravity [m/s^2]"]), "at most" if judged else "reported",
                     0.005 if judged else None, 0.0, "conserved by the exact solution", run),
        tools.Result(CASE, f"defect in the program's energy ledger, {name}", "-", ledger_defect(run), "reported", None, 0.0, "energy balance", run)]


def corner(run, at):
    """Times [s] and downward displacement [m] of a corner of the thick beam: no particle sits there, so a linear field is fitted to those nearest to it."""
    frames = list(run.frames)
    at = np.array(at, dtype=float)
    start = frames[0]["position"][:, :len(at)]
    down = -np.array([fields.extended(start, frame["displacement"][:, len(at) - 1], at, 12 if len(at) == 2 else 24) for frame in frames])
    return np.minimum(np.arange(len(frames)) * FRAMES, run.history["time"][-1]), down


def peak(times, down, before=1.2):
    """Time [s] and size [m] of the first largest deflection, by a parabola through three frames."""
    top = min(int(np.argmax(np.where(times <= before, down, -np.inf))), len(times) - 2)
    parabola = np.polyfit(times[top - 1:top + 2] - times[top], down[top - 1:top + 2], 2)
    shift = -parabola[1] / (2 * parabola[0])
    return float(times[top] + shift), float(np.polyval(parabola, shift))


def turned(lab, angle, size, method=None):
    """The run of the slender beam, its mesh and gravity turned by `angle` [deg] about the clamp, with the method of the scene or another."""
    cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))

    def turn(points):
        return [[round(float(cos * x - sin * y), 12), round(float(sin * x + cos * y), 12)] for x, y in points]

    edge = np.array(turn([[0, -6], [0, 2]]))  # clamped side of the room
    return lab.run(f"{CASE}/scene_turned.yaml", f"turned_{angle}{'_' + tools.label(method) if method else ''}", {
        **tools.METHODS.get(method, {}), "mesh.size": size,
        "mesh.regions[0].shape.points": turn([[0, -1], [10, -1], [10, 1], [0, 1]]), "mesh.regions[1].shape.points": turn([[0, -6], [11, -6], [11, 2], [0, 2]]),
        "mesh.groups[0].within.low": [float(x) for x in edge.min(axis=0) - 1e-3], "mesh.groups[0].within.high": [float(x) for x in edge.max(axis=0) + 1e-3],
        "loads[0].acceleration": turn([[0, -9.81]])[0], "outputs.history.points[0].at": turn([[10, 0]])[0]})


def lowest(run, angle):
    """First largest displacement of the tip of a turned beam along gravity [m], and when [s]."""
    along = run.history["tip_ux"] * np.sin(np.radians(angle)) - run.history["tip_uy"] * np.cos(np.radians(angle))
    at = int(np.argmax(along))
    return float(along[at]), float(run.history["time"][at])


def judge_turned(runs, data, note):
    """Results of the turned beams: each against finite elements, and how far they are apart."""
    own, reference = data["turned"], -data["first minimum [m]"]
    found = {angle: lowest(run, angle)[0] for angle, run in runs.items()}
    results = [tools.Result(CASE, f"turned by {angle} degrees: first largest deflection, {note}", "m", found[angle], "within", own["largest error"],
                            reference, own["source"], run) for angle, run in runs.items()]
    spread = (max(found.values()) - min(found.values())) / reference
    return results + [tools.Result(CASE, f"spread of the deflection over all angles, {note}", "-", spread, "reported", None, 0.0,
                                   "indifference to the frame", list(runs.values())[-1])]


def judge_short(name, run, data, published):
    """Results of the thick beam; beside the published material points, whose scatter the difference to the published curve shows."""
    own, (times, down) = data["short"], corner(run, [4, 0])
    time, largest = peak(times, down)
    judged = "within", own["slack"]
    apart = np.interp(published["time"], times, down) - published["cpdi_nh"]
    early = published["time"] <= 1.6
    return [
        tools.Result(CASE, f"first largest deflection, {name}", "m", largest, *judged, own["largest deflection [m]"], own["source"], run),
        tools.Result(CASE, f"time of the first largest deflection, {name}", "s", time, *judged, own["time [s]"], own["source"], run),
        tools.Result(CASE, f"rms from published material points of the same law up to 1.6 s, {name}", "m", tools.rms(apart[early]), "reported", None, 0.0,
                     "short_history.csv, cpdi_nh", run),
        tools.Result(CASE, f"rms from published material points of the same law up to 2.8 s, {name}", "m", tools.rms(apart), "reported", None, 0.0,
                     "short_history.csv, cpdi_nh", run)]


def judge_solid(size, run, data):
    """Results of the thick beam in three dimensions."""
    own, (time, largest) = data["solid"], peak(*corner(run, [4, 0, 0]))
    name = f"thick beam in three dimensions, cells of {size} m"
    return [tools.Result(CASE, f"first largest deflection, {name}", "m", largest, "reported", None, own["largest deflection [m]"], own["source"], run),
            tools.Result(CASE, f"time of the first largest deflection, {name}", "s", time, "reported", None, own["time [s]"], own["source"], run)]


def draw_short(figure, runs, solids, published):
    """The thick beam in two and three dimensions over the published histories."""
    axis = figure.subplots()
    for name, run in runs.items():
        axis.plot(*corner(run, [4, 0]), label=f"talus, {name}")
    for size, run in solids.items():
        axis.plot(*corner(run, [4, 0, 0]), ":", label=f"talus in 3-D, cells of {size} m")
    for name, mark, words in (("fem", "ko", "finite elements of the paper"), ("cpdi", "k^", "CPDI of the paper"), ("cpdi_nh", "k+", "CPDI, neo-Hookean")):
        axis.plot(published["time"], published[name], mark, markersize=4, fillstyle="none", label=words)
    axis.set(xlabel="time [s]", ylabel="deflection of the lower corner [m]")
    axis.legend(fontsize=7)


def named(size, method):
    """What results of a run are called."""
    return f"cells of {size} m{', ' + method if method else ''}"


def started(lab, scene, label, size, method):
    """Starts a scene with the method that it has, or another."""
    return lab.run(f"{CASE}/{scene}.yaml", f"{label}{size}{'_' + tools.label(method) if method else ''}", {"mesh.size": size, **tools.CHOICES.get(method, {})})


def evaluate(lab):
    """Results for the sizes of the level: the slender beam, the same turned, the thick beam in two and three dimensions."""
    data, curve, published = tools.reference(CASE), tools.reference(CASE, "fe_history.csv"), tools.reference(CASE, "short_history.csv")
    plan = [*((size, None) for size in SIZES[lab.level]), *((size, method) for method in (OTHER, *BENDING) for size in OTHER_SIZES[lab.level])]
    runs = {named(size, method): (size, started(lab, "scene", "dx", size, method)) for size, method in plan}
    plan = [*((size, None) for size in SHORT[lab.level]), *((size, OTHER) for size in SHORT[lab.level][:None if lab.level == "full" else 1])]
    short = {named(size, method): started(lab, "scene_short", "short_", size, method) for size, method in plan}
    solid = {size: lab.run(f"{CASE}/scene_short_3d.yaml", f"solid_{size}", {"mesh.size": size}) for size in SOLID[lab.level]}
    around = {angle: turned(lab, angle, 0.5) for angle in ANGLES[lab.level]}
    others = {angle: turned(lab, angle, 0.25, OTHER) for angle in OTHER_ANGLES[lab.level]}
    lab.figure(CASE, "verification_cantilever", lambda figure: draw(figure, {name: run for name, (_, run) in runs.items()}, curve), caption="Tip of the cantilever over three periods.")
    lab.figure(CASE, "verification_cantilever_thick", lambda figure: draw_short(figure, short, solid, published),
               caption="Lower corner of the thick cantilever over published histories.")
    results = [result for name, (size, run) in runs.items() for result in judge(name, size, run, curve, data)]
    results += [result for name, run in short.items() for result in judge_short(f"thick beam, {name}", run, data, published)]
    results += [result for size, run in solid.items() for result in judge_solid(size, run, data)]
    return results + judge_turned(around, data, "cells of 0.5 m") + judge_turned(others, data, f"cells of 0.25 m, {OTHER}")


def tradeoff(lab):
    """Error of the tip over its first minimum and three periods, that of evaluate()."""
    data, curve = tools.reference(CASE), tools.reference(CASE, "fe_history.csv")
    return tools.Tradeoff(
        scene=f"{CASE}/scene.yaml",
        axes={"mesh": {f"cells of {size} m": {"mesh.size": size} for size in SWEPT[lab.level]},
              "particles": {f"{count} particles": {"bodies[0].particles_per_cell": count} for count in (4, 3, 6)},
              "method": tools.METHODS,
              "reference": {"renewed in each step": {}, **{f"reference kept to a strain of {strain}": {
                  "bodies[0].reference": {"update": "adaptive", "distortion": strain}} for strain in (0.01, 0.05, 0.2)},
                  "reference never renewed": {"bodies[0].reference": {"update": "never"}}},
              "step": {f"CFL {share}": {"time.cfl": share} for share in (0.4, 0.8)}},
        error=lambda run: history_error(run.history, curve, data),
        what="rms error of the tip of the cantilever over 4 s")
