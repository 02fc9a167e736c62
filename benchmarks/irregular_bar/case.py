"""The vibrating bar on irregular meshes: where the error stops to fall, and what plain hats do there."""
import bar_mode
import lab as tools

CASE = "irregular_bar"
SIZES = {"quick": [1, 0.5, 0.25], "full": [1, 0.5, 0.25, 0.125]}
KERNELS = {"umls": "tpic", "linear": "flip", "projected": "aflip"}  # each with the transfer that suits it
MARKS = {"umls": "o", "linear": "s", "projected": "^"}
RATIOS = {"quick": [1.2, 2], "full": [1.2, 1.5, 2, 4, 10]}  # size of the cells outside over that inside a strip in the middle of the bar
MESHES = {"jittered": "scene.yaml", "gmsh": "scene_gmsh.yaml"}


def settings(mesh, kernel, size):
    """Changes to the scene for cells of `size` [m]."""
    cells = {"mesh.grid.cells": [round(30 / size), round(2 / size)]} if mesh == "jittered" else {"mesh.size": size}
    return {**cells, "kernel": kernel, "transfer.scheme": KERNELS[kernel]}


def graded(lab, kernel, ratio):
    """Starts the bar on cells of 0.5 m that are smaller in a strip from 12 to 14 m."""
    refine = f"[{{within: {{low: [12, 0], high: [14, 2]}}, size: {0.5 / ratio:.4g}}}]"
    return lab.run(f"{CASE}/scene_gmsh.yaml", f"graded_{kernel}_{ratio}", {**settings("gmsh", kernel, 0.5), "mesh.refine": refine})


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
    sizes = SIZES[lab.level]
    for mesh, scene in MESHES.items():
        for kernel in KERNELS:
            runs = [lab.run(f"{CASE}/{scene}", f"{mesh}_{kernel}_dx{size}", settings(mesh, kernel, size)) for size in sizes]
            curves[mesh, kernel] = sizes, runs
            for size, run in zip(sizes, runs):
                judged = kernel != "linear" and size == 0.5
                results.append(tools.Result(CASE, f"displacement error, cells of {size} m, {mesh}, {kernel}", "-", error(run, data),
                                            "at most" if judged else "reported", data["largest error at 0.5 m"] if judged else None, 0.0,
                                            data["source"], run))
    for mesh in MESHES:
        runs = curves[mesh, "projected"][1]
        errors = [error(run, data) for run in runs]
        lab.convergence(CASE, f"displacement error, {mesh}, projected", sizes, errors, expected=2)
        results.append(tools.Result(CASE, f"order of convergence, {mesh}, projected", "-", tools.observed_order(sizes, errors), "at least", 1.8, 2.0,
                                    data["source"], runs[-1]))
    strips = {(kernel, ratio): graded(lab, kernel, ratio) for ratio in RATIOS[lab.level] for kernel in KERNELS}
    results += [tools.Result(CASE, f"displacement error, cells of 0.5 m, {ratio} times smaller in a strip, {kernel}", "-", error(run, data), "reported", None, 0.0,
                             data["source"], run) for (kernel, ratio), run in strips.items()]
    lab.figure(CASE, "verification_irregular", lambda figure: draw(figure, curves, data),
               caption="Error of the bar on irregular meshes over one period: it stops to fall, see the page of the kernels.")
    return results
