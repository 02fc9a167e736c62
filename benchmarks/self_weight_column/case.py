"""Column under its own weight: stress at the particles and settlement of the top against closed forms in finite strain."""
import numpy as np

import lab as tools

CASE = "self_weight_column"
LAWS = ["linear_elastic", "neo_hookean", "hencky", "linear_first_piola"]
OTHER = "projected, aflip"  # method beside that of the scene, with one law
INTERVALS = {"quick": [10, 20, 40], "full": [10, 20, 40, 80]}  # cells over the height of 50 m


def settings(law, intervals, data):
    """Changes to the scene for `intervals` square cells over the height, two over the width."""
    size, height = data["height [m]"] / intervals, data["height [m]"]
    return {"mesh.grid.cells": [2, round(1.2 * intervals)], "mesh.grid.high": [2 * size, 1.2 * height], "bodies[0].shape.high": [2 * size, height],
            "materials[0].law": law}


def stretch(law, pressure, modulus):
    """Stretch F at a Cauchy pressure in uniaxial strain without lateral contraction (nu = 0: lambda = 0, 2 mu = M)."""
    if law == "linear_elastic":
        return np.exp(-pressure / modulus)
    ratio = pressure / modulus
    if law == "linear_first_piola":
        return 1 - ratio
    if law == "hencky":  # M ln F / F = -pressure: F = exp(-W(ratio)) with Lambert's W, by iteration
        logarithm = np.zeros_like(ratio)
        for _ in range(50):
            logarithm = -ratio * np.exp(logarithm)
        return np.exp(logarithm)
    # neo-Hookean: M/2 (F^2 - 1) / F = -pressure
    return -ratio + np.sqrt(ratio**2 + 1)


def settlement(law, height, data, points=2001):
    """Settlement [m] of what was at `height`: the integral of 1 - F from the base, by the trapezoidal rule."""
    y = np.linspace(0, height, points)
    return float(np.trapz(1 - stretch(law, data["weight [N/m^3]"] * (data["height [m]"] - y), data["modulus [Pa]"]), y))


def stress_error(run, data):
    """Mean over the mass of the error in vertical stress at each particle, relative to the stress at the base."""
    frame = run.last_frame()
    height = frame["position"][:, 1] - frame["displacement"][:, 1]
    exact = -data["weight [N/m^3]"] * (data["height [m]"] - height)
    wrong = np.average(np.abs(frame["stress"][:, 1] - exact), weights=frame["mass"])
    return float(wrong / (data["weight [N/m^3]"] * data["height [m]"]))


def top_settlement(run):
    """Height before loading and settlement of the highest particle [m]."""
    frame = run.last_frame()
    height = frame["position"][:, 1] - frame["displacement"][:, 1]
    top = int(np.argmax(height))
    return float(height[top]), float(-frame["displacement"][top, 1])


def draw(figure, sizes, errors, run, data):
    """Left the error over the size of cells, right the stress of the finest run over the height."""
    left, right = figure.subplots(1, 2)
    for (name, values), mark in zip(errors.items(), ["o-", "x--", "s:", "+-.", "^-"]):
        left.loglog(sizes, np.array(values) * 100, mark, label=name.replace("_", " "))
    left.loglog(sizes, 0.5 * np.array(sizes) / sizes[0], "k:", label="order 1")
    tools.size_axis(left, sizes)
    left.set(ylabel="error in stress [%]")
    left.legend()
    frame = run.last_frame()
    height = frame["position"][:, 1] - frame["displacement"][:, 1]
    right.plot(frame["stress"][:, 1] / 1e3, height, ".", markersize=2, label="particles")
    right.plot([-data["weight [N/m^3]"] * data["height [m]"] / 1e3, 0], [0, data["height [m]"]], "k-", linewidth=0.8, label="exact")
    right.set(xlabel="vertical stress [kPa]", ylabel="height before loading [m]")
    right.legend()


def evaluate(lab):
    """Results for four laws, and for one with another method."""
    data, results, errors = tools.reference(CASE), [], {}
    intervals = INTERVALS[lab.level]
    sizes = [data["height [m]"] / n for n in intervals]
    plan = {law: (law, {}) for law in LAWS} | {f"neo_hookean, {OTHER}": ("neo_hookean", tools.METHODS[OTHER])}
    started = {name: [lab.run(f"{CASE}/scene.yaml", f"{tools.label(name)}_{n}", {**settings(law, n, data), **method}) for n in intervals]
               for name, (law, method) in plan.items()}
    for name, runs in started.items():
        if any(run.failure() for run in runs):
            continue
        law = plan[name][0]
        errors[name] = [stress_error(run, data) for run in runs]
        height, measured = top_settlement(runs[-1])
        results += [
            tools.Result(CASE, f"stress error, cells of {sizes[-1]} m, {name}", "-", errors[name][-1], "at most", 0.005, 0.0, data["stress source"], runs[-1]),
            tools.Result(CASE, f"order of the stress error, {name}", "-", tools.observed_order(sizes, errors[name]), "at least", 1.0, 1.0,
                         data["order source"], runs[-1]),
            tools.Result(CASE, f"settlement of the top, {name}", "m", measured, "within", 0.01, settlement(law, height, data), data["top source"], runs[-1])]
    lab.figure(CASE, "verification_column", lambda figure: draw(figure, sizes, errors, started[LAWS[-1]][-1], data), size=(7.2, 3.2),
               caption="Column under its own weight: error in vertical stress, and stress of the finest run.")
    return results
