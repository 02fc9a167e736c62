"""Surfaces that cut cells, under loads or free: pressed square and cube, sheared square, disk in water, hanging bar."""
import numpy as np

import lab as tools

CASE = "loaded_surface"
PLACES = (1, 1.04, 1.08)  # factors of the cell size: the end lies elsewhere in its cells

# Hanging bar: sizes of cells [m], and how much the room is higher than that of the scene [m], with which gmsh makes other triangles.
HANGING = {(0.25, 0): "full", (0.25, 0.03): "full", (0.25, 0.06): "full", (0.125, 0): "quick", (0.125, 0.03): "full", (0.125, 0.06): "full",
           (0.0625, 0.013): "full", (0.0625, 0.03): "full", (0.0625, 0.06): "full"}


def error(run, wrong, share=1):
    """Root of the mean over the mass of the square of a relative error, in that share of the length that is farthest from the loaded end."""
    frame = run.last_frame()
    part = frame["position"][:, 0] <= share * frame["position"][:, 0].max()
    return float(np.sqrt(np.average(wrong(frame)[part]**2, weights=frame["mass"][part])))


def pressed(data):
    """The error of the stress along the load, over the load."""
    return lambda frame: frame["stress"][:, 0] / -data["pressure [Pa]"] - 1


def pressed_between_free_sides(data):
    """The error of the whole stress, over the load."""
    exact = np.array([-data["pressure [Pa]"], 0, 0, 0, 0, 0])
    return lambda frame: np.linalg.norm(frame["stress"] - exact, axis=1) / data["pressure [Pa]"]


def sheared(data):
    """The error of the stress in the plane, over the traction."""
    exact = np.array([0, 0, data["traction [Pa]"]])
    return lambda frame: np.linalg.norm(frame["stress"][:, [0, 1, 3]] - exact, axis=1) / data["traction [Pa]"]


def in_water(data):
    """The error of the stress in the plane, over the pressure of the water at the height of the disk."""
    def wrong(frame):
        pressure = data["weight of water [N/m^3]"] * (data["water level [m]"] - frame["position"][:, 1])
        stress = frame["stress"][:, [0, 1, 3]] + pressure[:, None] * np.array([1, 1, 0])
        return np.linalg.norm(stress, axis=1) / (data["weight of water [N/m^3]"] * data["height [m]"])
    return wrong


def hanging_results(lab, data):
    """The hanging bar: errors of the stress over the exact one at the same place, in the two cells next to the free side and below, away from the ends."""
    own, results = data["hanging"], []
    runs = {(size, higher): lab.run(f"{CASE}/scene_hanging.yaml", f"hanging_{size}_{higher}", {"mesh.size": size, "mesh.regions[0].shape.high": [4.6, 1.45 + higher]})
            for (size, higher), level in HANGING.items() if level == "quick" or lab.level == "full"}
    for (size, higher), run in runs.items():
        frame = run.last_frame()
        x, y = frame["position"][:, 0], frame["position"][:, 1]
        exact = own["weight [N/m^3]"] * (own["length [m]"] - x)
        wrong = np.hypot(np.hypot(frame["stress"][:, 0] - exact, frame["stress"][:, 1]), np.sqrt(2) * frame["stress"][:, 3]) / exact
        middle, top = (x > own["from [m]"]) & (x < own["to [m]"]), y > own["height [m]"] - 2 * size
        name = f"hanging bar, {tools.mesh_name(size, higher)}"
        results += [tools.Result(CASE, f"stress error, rms, two cells at the free side, {name}", "-", tools.rms(wrong[middle & top]), "at most", own["largest error"], 0.0,
                                 own["source"], run),
                    tools.Result(CASE, f"largest stress error, two cells at the free side, {name}", "-", float(wrong[middle & top].max()), "reported", None, 0.0, own["source"], run),
                    tools.Result(CASE, f"stress error, rms, below these cells, {name}", "-", tools.rms(wrong[middle & ~top]), "reported", None, 0.0, own["source"], run)]
    return results


def evaluate(lab):
    """The pressed square with cells of several sizes at three places, its load on sides or facets; the others with one size, or two."""
    data, results = tools.reference(CASE), []
    sizes = [1 / 8, 1 / 16] if lab.level == "quick" else [1 / 8, 1 / 16, 1 / 32]
    square = {(kind, size): [lab.run(f"{CASE}/{scene}.yaml", f"{kind}_{size}_{place}", {"mesh.size": size * place}) for place in PLACES]
              for kind, scene in (("side", "scene"), ("facets", "scene_facets")) for size in sizes}
    cells = [8] if lab.level == "quick" else [8, 16]
    cubes = {("between rollers", n): lab.run(f"{CASE}/scene_cube.yaml", f"cube_{n}", {"mesh.grid.cells": [3 * n // 2, n, n]}) for n in cells}
    cubes |= {("with free sides", n): lab.run(f"{CASE}/scene_cube.yaml", f"free_cube_{n}", {
        "mesh.grid": f"{{low: [0, 0, 0], high: [1.5, 1.5, 1.5], cells: [{3 * n // 2}, {3 * n // 2}, {3 * n // 2}], jitter: 0.2}}", "bodies[0].shape.high": [1.05, 1.05, 1.05],
        "boundaries": "[{type: roller, on: x_min}, {type: roller, on: y_min}, {type: roller, on: z_min}]"}) for n in cells}
    others = {(scene, size): lab.run(f"{CASE}/scene_{scene}.yaml", f"{scene}_{size}", {"mesh.size": size}) for scene in ("shear", "water") for size in sizes}

    def add(name, value, criterion, limit, run, unit="-"):
        results.append(tools.Result(CASE, name, unit, value, criterion, data[limit] if limit else None, 0.0, data["source"], run))

    means = {}
    for (kind, size), runs in square.items():
        judged = kind == "side"
        for share, where in ((1, "everywhere"), (2 / 3, "without the third next to the load")):
            value = tools.rms([error(run, pressed(data), share) for run in runs])
            means[kind, size, share] = value
            asked = judged and share < 1
            add(f"stress error over the load, rms, pressed square, load on {'the side' if judged else 'facets'}, cells of {size} m, {where}", value,
                "at most" if asked else "reported", "largest error" if asked else None, runs[0])
    lab.convergence(CASE, "stress error of the pressed square", sizes, [means["side", size, 1] for size in sizes], expected=1)
    for (sides, n), run in cubes.items():
        wrong, asked = (pressed(data), True) if sides == "between rollers" else (pressed_between_free_sides(data), False)
        for share, where in ((1, "everywhere"), (2 / 3, "without the third next to the load")):
            judged = asked and share < 1
            add(f"stress error over the load, rms, pressed cube {sides}, cells of 1/{n} m, {where}", error(run, wrong, share), "at most" if judged else "reported",
                "largest error" if judged else None, run)
    for (scene, size), run in others.items():
        wrong, name = (sheared(data), "sheared square, over the traction") if scene == "shear" else (in_water(data), "disk in water, over its pressure across the disk")
        add(f"stress error, rms, {name}, cells of {size} m", error(run, wrong), "reported", None, run)
        if scene == "water":
            add(f"displacement of the disk, cells of {size} m", float(np.linalg.norm(np.average(run.last_frame()["displacement"], axis=0, weights=run.last_frame()["mass"]))),
                "reported", None, run, "m")
    results += hanging_results(lab, data)
    lab.figure(CASE, "verification_loaded_surface", lambda figure: tools.draw_pressing_stress(figure, {"load on facets": square["facets", sizes[1]][0], "load on the side": square["side", sizes[1]][0]}, data),
               size=(9.6, 3.2), caption="Square pressed on its right end by a third of its modulus: stress of the particles over the exact one, which is uniform.")
    return results
