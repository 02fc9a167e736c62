"""Failure of a clayey slope in tetrahedra between smooth walls: surface and motion beside plane strain, and what varies across the width."""
import numpy as np

import lab as tools

CASE = "slope_failure_3d"
TPIC, FLIP = {}, {"transfer.scheme": "flip", "stages[0].residual": 0.03}  # with flip tetrahedra do not come to rest to less within 20 s
VARIANTS = {  # name: cells [m], changes, level
    "cells of 3.5 m": (3.5, TPIC, "quick"), "cells of 2.5 m": (2.5, TPIC, "full"), "cells of 3.5 m, flip": (3.5, FLIP, "full")}
SLICES = 3  # across the width, to see what varies
slope = tools.module("slope_failure_2d")
PLACES = np.arange(*slope.SCORED, 0.5)  # m, where surfaces are compared


def profile(frame, spacing):
    """Height [m] of the free surface at PLACES: the highest particles, as in slope_failure_2d."""
    return np.interp(PLACES, *slope.surface(frame, spacing))


def slices(run, width):
    """Surfaces of slices across the `width` [m] one row each."""
    frame, spacing = run.last_frame(), slope.spacing(run)
    own = np.minimum((frame["position"][:, 2] / width * SLICES).astype(int), SLICES - 1)
    return np.array([profile({"position": frame["position"][own == k]}, spacing) for k in range(SLICES)])


def apart(solid, plane):
    """Root mean square [m] of the difference of the surfaces in three and in two dimensions."""
    high, flat = (profile(run.last_frame(), slope.spacing(run)) for run in (solid, plane))
    return tools.rms(high - flat)


def uneven(run, width):
    """Root mean square and largest [m] of the differences between the surfaces of slices across the `width` [m] and their mean."""
    off = slices(run, width)
    off = off - off.mean(axis=0)
    return tools.rms(off), float(np.max(np.abs(off)))


def sideways(run):
    """Root mean square of the displacement across the width over that of the whole displacement, of particles at the end."""
    moved = run.last_frame()["displacement"]
    return float(np.linalg.norm(moved[:, 2]) / np.linalg.norm(moved))


def momentum_across(run):
    """Largest momentum across the width over the largest momentum along the slope."""
    return float(np.max(np.abs(run.history["momentum_z"])) / np.max(np.abs(run.history["momentum_x"])))


def sinking(run):
    """Time since the slope began to fail [s] and how deep its crest has sunk since [m]."""
    failing = run.history["stage"] == run.history["stage"][-1]
    time, height = run.history["time"][failing], run.history["crest_uy"][failing]
    return time - time[0], height[0] - height


def crest_error(solid, plane):
    """Largest difference over time between how deep the crest has sunk in three and in two dimensions, over how deep it sinks in two."""
    (time, deep), (own, flat) = sinking(solid), sinking(plane)
    return float(np.max(np.abs(deep - np.interp(time, own, flat))) / flat[-1])


def judge(name, solid, plane, info, data):
    """Results of one of VARIANTS in tetrahedra and in the plane."""
    size, spacing, (rough, roughest) = VARIANTS[name][0], slope.spacing(plane), uneven(solid, info["width [m]"])
    published = f"{info['source']} ({info['nature']})"

    def result(metric, unit, value, criterion, tolerance, reference, source):
        return tools.Result(CASE, f"{metric}, {name}", unit, value, criterion, tolerance, reference, source, solid)

    return [
        result("surface beside plane strain, rms over 15 < x < 60 m", "m", apart(solid, plane), "at most", spacing, 0.0, info["plane source"]),
        result("toe of the debris", "m", slope.toe(solid.last_frame(), slope.spacing(solid)), "near", 2 * size,
               slope.toe(plane.last_frame(), spacing), info["plane source"]),
        result("sinking of the crest beside plane strain, largest difference over the last depth", "-", crest_error(solid, plane),
               "reported", None, 0.0, info["plane source"]),
        result("published surface, rms over 15 < x < 60 m", "m", slope.surface_error(solid, data), "at most", size, 0.0, published),
        result("the same in plane strain", "m", slope.surface_error(plane, data), "reported", None, 0.0, published),
        result("surface of slices across the width about their mean, rms", "m", rough, "at most", spacing, 0.0, "plane strain"),
        result("the same, largest", "m", roughest, "reported", None, 0.0, "plane strain"),
        result("displacement across the width over displacement, rms", "-", sideways(solid), "reported", None, 0.0, "plane strain"),
        result("largest momentum across the width over that along the slope", "-", momentum_across(solid), "reported", None, 0.0, "plane strain"),
        result("energy defect over dissipated energy", "-", slope.energy_defect(solid), "at most", 0.01, 0.0, "energy balance"),
        result("change of mass", "-", slope.mass_error(solid), "at most", 1e-12, 0.0, "mass balance")]


def draw(figure, runs, info, data):
    """Final surfaces of slices across the width and of plane strain over the reference, and how the crest sinks."""
    left, right = figure.subplots(1, 2, width_ratios=[2, 1])
    left.plot([0, 30, 50, 110], [35, 35, 15, 15], color="0.7", label="before")
    left.plot(data["x"], data["y"], "k.", label="Huang et al. 2015 (numerical)")
    for colour, (name, (solid, plane)) in zip(("C0", "C1", "C2"), runs.items()):
        left.plot(PLACES, slices(solid, info["width [m]"]).T, colour, lw=0.8)
        left.plot(PLACES, profile(plane.last_frame(), slope.spacing(plane)), colour, ls="--")
        right.plot(*sinking(solid), colour, label=name)
        right.plot(*sinking(plane), colour, ls="--")
    left.set(xlim=(10, 65), ylim=(12, 37), xlabel="x [m]", ylabel="y [m]", aspect="equal", title="surface: slices across; dashed: plane strain")
    left.legend(fontsize=7)
    right.set(xlabel="time [s]", ylabel="sinking of the crest [m]")
    right.legend(fontsize=7)


def evaluate(lab):
    """The slope with peak strength in three and in two dimensions, in cells of the same size."""
    info, data = tools.reference(CASE), tools.reference("slope_failure_2d", "surface.csv")
    runs = {name: [lab.run(f"{CASE}/{scene}.yaml", tools.label(f"{scene}_{name}"), {"mesh.size": size, **changes})
                   for scene in ("scene", "scene_plane")]
            for name, (size, changes, level) in VARIANTS.items() if level in ("quick", lab.level)}
    lab.figure(CASE, "verification_slope_3d", lambda figure: draw(figure, runs, info, data), size=(9, 2.8),
               caption="Free surface 7.2 s after the start of the failure, in tetrahedra and in plane strain, and sinking of the crest.")
    return [result for name, (solid, plane) in runs.items() for result in judge(name, solid, plane, info, data)]
