"""Axial vibration of a bar: error against the exact mode, and how it falls with the size of the cells."""
import numpy as np

import bar_mode
import lab as tools

CASE = "vibrating_bar"
SIZES = {"quick": [1, 0.5, 0.25], "full": [1, 0.5, 0.25, 0.125]}  # m
METHODS = {"flip": tools.METHODS["umls, flip"], "tpic": tools.METHODS["umls, tpic"], "projected, aflip": tools.METHODS["projected, aflip"]}
SWINGS = {"umls": "umls, tpic", "umls, flip": "umls, flip", "linear": "linear, flip", "projected": "projected, aflip"}  # name of the result: method
PERIOD = 10  # s


def settings(size, speed):
    """Changes to the scene for square cells of `size` [m], two of them over the height, and an initial speed of `speed` [m/s]."""
    return {"mesh.grid.cells": [round(30 / size), 2], "mesh.grid.high": [30, 2 * size], "bodies[0].shape.high": [25, 2 * size],
            "bodies[0].velocity": [f"{speed} * sin(pi * x / 50)", "0"]}


def sweep(lab, method, speed):
    """Starts the runs of all sizes."""
    sizes = SIZES[lab.level]
    return sizes, [lab.run(f"{CASE}/scene.yaml", f"{tools.label(method)}_v{speed}_dx{size}", {**settings(size, speed), **METHODS[method]}) for size in sizes]


def held(lab, size):
    """Starts the bar held at both ends, at 0.001 m/s: mode sin(pi X / L), period 5 s."""
    return lab.run(f"{CASE}/scene.yaml", f"held_umls_tpic_dx{size}", {
        **settings(size, 0.001), **METHODS["tpic"], "mesh.grid.cells": [round(25 / size), 2], "mesh.grid.high": [25, 2 * size],
        "bodies[0].velocity": ["0.001 * sin(pi * x / 25)", "0"],
        "boundaries": "[{type: fixed, on: x_min}, {type: fixed, on: x_max}, {type: roller, on: y_min}, {type: roller, on: y_max}]"})


def large(lab, name, size):
    """Starts a swing of 3.2 m at the tip, strain up to 20 %: particles cross many cells and the mode is still exact."""
    return lab.run(f"{CASE}/scene.yaml", f"large_{tools.label(SWINGS[name])}_dx{size}", {**settings(size, 2), **tools.METHODS[SWINGS[name]]})


def beyond(lab, data):
    """Results of the bar held at both ends, of which the order is judged, and of the large swing."""
    sizes, half = SIZES[lab.level][:3], {**data, "length [m]": data["length [m]"] / 2}  # a quarter of a wave is half the bar
    coarse = sizes[:2] if lab.level == "quick" else sizes
    runs = [held(lab, size) for size in sizes]
    swings = {(name, size): large(lab, name, size) for name in SWINGS for size in (coarse[:1] if name == "umls, flip" and lab.level == "quick" else coarse)}
    errors = [bar_mode.displacement_error(run.history, half, 0.001) for run in runs]
    lab.convergence(CASE, "displacement error, held at both ends, tpic, v0 = 0.001 m/s", sizes, errors, expected=2)
    return [tools.Result(CASE, "order of convergence, held at both ends, tpic, v0 = 0.001 m/s", "-", tools.observed_order(sizes, errors), "at least", 1.8, 2.0,
                         data["source"], runs[-1]),
            *(tools.Result(CASE, f"displacement error, v0 = 2 m/s, cells of {size} m, {name}", "-", bar_mode.displacement_error(run.history, data, 2), "reported",
                           None, 0.0, data["source"], run) for (name, size), run in swings.items())]


def energy_change(run):
    """Change of kinetic and strain energy from the first period to the last; means, as a row has velocities half a step behind positions."""
    energy, time = run.history["kinetic"] + run.history["strain"], run.history["time"]
    return float(abs(np.mean(energy[time > time[-1] - PERIOD]) / np.mean(energy[time <= PERIOD]) - 1))


def draw_orders(figure, curves):
    """Error over size of cell, one line per method and speed."""
    axis = figure.subplots()
    for (method, speed), (sizes, _, errors) in curves.items():
        axis.loglog(sizes, np.array(errors) * 100, "o-" if speed == 0.1 else "s--", label=f"{method}, v0 = {speed} m/s")
    axis.loglog([1, 0.25], [0.5, 0.5 / 16], "k:", label="order 2")
    axis.loglog([0.5], [0.554], "kx", label="bound of Cao et al.")
    tools.size_axis(axis, SIZES["full"])
    axis.set_ylabel("error in displacement [% of amplitude]")
    axis.legend(fontsize=8)


def judge_errors(method, sizes, runs, errors, data):
    """Errors at v0 = 0.1 m/s; the published bound is for cells of 0.5 m."""
    published, results = data["published rmse at 0.5 m"], []
    for size, run, value in zip(sizes, runs, errors):
        judged = size == 0.5
        results.append(tools.Result(CASE, f"displacement error, cells of {size} m, {method}", "-", value, "at most" if judged else "reported",
                                    published["value"] if judged else None, 0.0, published["source"] if judged else data["source"], run))
    half = runs[sizes.index(0.5)]
    bound = data["published energy error at 0.5 m"]
    results.append(tools.Result(CASE, f"change of energy in 40 s, cells of 0.5 m, {method}", "-", energy_change(half), "at most", bound["value"], 0.0,
                                bound["source"], half))
    return results


def evaluate(lab):
    """Results for the methods at v0 = 0.1 m/s (particles cross cells) and 0.001 m/s (they do not: the mesh alone)."""
    data = tools.reference(CASE)
    started = {(method, speed): sweep(lab, method, speed) for speed in (0.1, 0.001) for method in METHODS}
    curves = {(method, speed): (sizes, runs, [bar_mode.displacement_error(run.history, data, speed) for run in runs])
              for (method, speed), (sizes, runs) in started.items()}
    results = []
    for (method, speed), (sizes, runs, errors) in curves.items():
        if speed == 0.1:
            results += judge_errors(method, sizes, runs, errors, data)
        judged = speed == 0.001
        results.append(tools.Result(CASE, f"order of convergence, {method}, v0 = {speed} m/s", "-", tools.observed_order(sizes, errors),
                                    "at least" if judged else "reported", 1.8 if judged else None, 2.0, data["source"], runs[-1]))
        lab.convergence(CASE, f"displacement error, {method}, v0 = {speed} m/s", sizes, errors, expected=2)
    results += beyond(lab, data)
    lab.figure(CASE, "verification_bar", lambda figure: draw_orders(figure, curves), caption="Error of the displacement of the bar over 40 s.")
    return results


def tradeoff(lab):
    """Amplitude 0.159 m: particles cross cells; the error is that of evaluate()."""
    data = tools.reference(CASE)
    return tools.Tradeoff(
        scene=f"{CASE}/scene.yaml",
        axes={"mesh": {f"cells of {size} m": settings(size, 0.1) for size in SIZES["full"]},
              "particles": {f"{count} particles": {"bodies[0].particles_per_cell": count} for count in (6, 3, 12)},
              "method": tools.METHODS,
              "step": {f"CFL {share}": {"time.cfl": share} for share in (0.4, 0.8, 0.2)}},
        error=lambda run: bar_mode.displacement_error(run.history, data, 0.1),
        what="error in displacement of the vibrating bar over four periods")
