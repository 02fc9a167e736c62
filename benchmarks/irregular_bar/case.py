"""The vibrating bar on irregular meshes: convergence of the error, also with linear shape functions."""
import numpy as np

import bar_mode
import lab as tools
import meshes

CASE = "irregular_bar"
SIZES = {"quick": [1, 0.5, 0.25], "full": [1, 0.5, 0.25, 0.125]}
MARKS = {"umls": "o", "linear": "s", "projected": "^"}
RATIOS = {"quick": [2], "full": [1.2, 2, 4, 10]}  # size of the cells outside over that inside a strip in the middle of the bar
MESHES = {"jittered": "scene.yaml", "gmsh": "scene_gmsh.yaml"}
LARGE = 2  # m/s: 3.2 m at the tip, strain of 20 %, in cells of 0.25 m particles cross 13 of them
SWINGS = {"umls, tpic": [1, 0.5], "umls, flip": [1, 0.5], "linear, flip": [1], "projected, aflip": [1, 0.5, 0.25],
          "projected, saflip": [1, 0.5, 0.25]}  # m
PERIOD, PERIODS = 10, 5  # s, and how many of them the longest swing takes


def settings(mesh, kernel, size):
    """Changes to the scene for cells of `size` [m]."""
    cells = {"mesh.grid.cells": [round(30 / size), round(2 / size)]} if mesh == "jittered" else {"mesh.size": size}
    return {**cells, "kernel": kernel, "transfer.scheme": tools.SUITED[kernel]}


def graded(lab, kernel, ratio):
    """Starts the bar on cells of 0.5 m that are smaller in a strip from 12 to 14 m."""
    refine = f"[{{within: {{low: [12, 0], high: [14, 2]}}, size: {0.5 / ratio:.4g}}}]"
    return lab.run(f"{CASE}/scene_gmsh.yaml", f"graded_{kernel}_{ratio}", {**settings("gmsh", kernel, 0.5), "mesh.refine": refine})


def bad(lab, kernel):
    """Starts the bar on squares of 0.5 m whose nodes are moved by nearly half of the spacing, and on squares of 1 m with slivers of 10 degrees."""
    sharp = meshes.slivered(*meshes.box([np.linspace(0, 30, 31), np.linspace(0, 2, 3)]), 10, 7)
    own = {"kernel": kernel, "transfer.scheme": tools.SUITED[kernel]}
    return {"cells of 0.5 m, nodes moved by 45 %": lab.run(f"{CASE}/scene.yaml", f"moved_{kernel}", {**settings("jittered", kernel, 0.5), "mesh.grid.jitter": 0.45}),
            "cells of 1 m, slivers of 10 degrees": lab.run(f"{CASE}/scene.yaml", f"slivers_{kernel}", {**own, **meshes.written(lab, CASE, "slivers", *sharp)})}


def swing(lab, method, size, periods):
    """Starts a large swing on the jittered mesh, with 18 particles per square: what is left is not that of summing over them."""
    return lab.run(f"{CASE}/scene.yaml", f"large_{tools.label(method)}_dx{size}", {
        "mesh.grid.cells": [round(30 / size), round(2 / size)], **tools.CHOICES[method], "bodies[0].particles_per_cell": 9,
        "bodies[0].velocity": [f"{LARGE} * sin(pi * x / 50)", "0"], "time.end": PERIOD * periods})


def swung(run, data, periods):
    """Error in displacement over so many periods, and the change of energy by their end: whole periods, as velocities are half a step behind places."""
    history = {name: values[run.history["time"] < (periods + 1e-6) * PERIOD] for name, values in run.history.items()}
    energy = history["kinetic"] + history["strain"]
    return bar_mode.displacement_error(history, data, LARGE), float(abs(energy[-1] / energy[0] - 1))


def judged(method, largest):
    """Criterion and tolerance of a result of a large swing: the default is asked."""
    return ("at most", largest) if method == "projected, aflip" else ("reported", None)


def judge_swings(lab, data):
    """Results of large swings with all methods; `projected` is asked for what it is built for."""
    own, results = data["large"], []
    plan = {(method, size): PERIODS if (method, size) in {("projected, aflip", 0.5), ("projected, saflip", 0.5)} else 1 for method, sizes in SWINGS.items() for size in sizes
            if lab.level == "full" or size > 0.25}
    runs = {(method, size): swing(lab, method, size, periods) for (method, size), periods in plan.items()}
    for (method, size), run in runs.items():
        wrong, lost = swung(run, data, 1)
        name, asked = f"large swing, cells of {size} m, {method}", "at most" if method == "projected, aflip" else "reported"
        results += [tools.Result(CASE, f"displacement error, {name}", "-", wrong, asked, own["largest error"][str(size)] if asked == "at most" else None, 0.0,
                                 own["source"], run),
                    tools.Result(CASE, f"change of energy in a period, {name}", "-", lost, asked, own["largest change of energy"] if asked == "at most" else None, 0.0,
                                 own["source"], run)]
    for (method, size), periods in plan.items():
        if periods > 1:
            wrong, lost = swung(runs[method, size], data, periods)
            name = f"{periods} periods of the large swing, cells of {size} m, {method}"
            results += [tools.Result(CASE, f"displacement error, {name}", "-", wrong, *judged(method, own["largest error over five periods"]), 0.0, own["source"], runs[method, size]),
                        tools.Result(CASE, f"change of energy, {name}", "-", lost, *judged(method, own["largest change of energy"]), 0.0, own["source"], runs[method, size])]
    return results


def error(run, data):
    """Error in displacement over one period, see bar_mode."""
    return bar_mode.displacement_error(run.history, data, data["speed [m/s]"])


def draw(figure, curves, data):
    """Error over size of cell."""
    axis = figure.subplots()
    for (mesh, kernel), (sizes, runs) in curves.items():
        axis.loglog(sizes, [error(run, data) * 100 for run in runs], MARKS[kernel] + ("-" if mesh == "jittered" else "--"),
                    label=f"{kernel}, {mesh}")
    tools.size_axis(axis, SIZES["full"])
    axis.set(ylabel="error in displacement [% of amplitude]")
    axis.legend()


def evaluate(lab):
    """Results on two irregular meshes and on graded ones with three kernels; judged are umls and projected at 0.5 m."""
    data, curves, results = tools.reference(CASE), {}, []
    for mesh, scene in MESHES.items():
        for kernel in tools.SUITED:
            few = lab.level == "quick" and (kernel == "linear" or (mesh, kernel) == ("gmsh", "umls"))  # known not to converge
            sizes = SIZES[lab.level][:2 if few else None]
            runs = [lab.run(f"{CASE}/{scene}", f"{mesh}_{kernel}_dx{size}", settings(mesh, kernel, size)) for size in sizes]
            curves[mesh, kernel] = sizes, runs
            for size, run in zip(sizes, runs):
                judged = kernel != "linear" and size == 0.5
                results.append(tools.Result(CASE, f"displacement error, cells of {size} m, {mesh}, {kernel}", "-", error(run, data),
                                            "at most" if judged else "reported", data["largest error at 0.5 m"] if judged else None, 0.0,
                                            data["source"], run))
    for mesh in MESHES:
        sizes, runs = curves[mesh, "projected"]
        errors = [error(run, data) for run in runs]
        lab.convergence(CASE, f"displacement error, {mesh}, projected", sizes, errors, expected=2)
        results.append(tools.Result(CASE, f"order of convergence, {mesh}, projected", "-", tools.observed_order(sizes, errors), "at least", 1.8, 2.0,
                                    data["source"], runs[-1]))
    strips = {(kernel, ratio): graded(lab, kernel, ratio) for ratio in RATIOS[lab.level] for kernel in tools.SUITED}
    results += [tools.Result(CASE, f"displacement error, cells of 0.5 m, {ratio} times smaller in a strip, {kernel}", "-", error(run, data), "reported", None, 0.0,
                             data["source"], run) for (kernel, ratio), run in strips.items()]
    worse = {(kernel, name): run for kernel in tools.SUITED for name, run in bad(lab, kernel).items()}
    results += [tools.Result(CASE, f"displacement error, {name}, {kernel}", "-", error(run, data), "reported", None, 0.0, data["source"], run)
                for (kernel, name), run in worse.items()]
    results += judge_swings(lab, data)
    lab.figure(CASE, "verification_irregular", lambda figure: draw(figure, curves, data),
               caption="Error of the bar on irregular meshes over one period: below a certain cell size it no longer decreases.")
    return results
