"""Consolidation: a layer that drains to one side (Terzaghi) and a ball that drains all round, in which pressures rise first (Cryer)."""
import numpy as np
import scipy.optimize

import lab as tools

CASE = "consolidation"
SIZES = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # m
WIDTHS = {0.4: "quick", 0.41: "full", 0.42: "full"}  # m: gmsh then makes other triangles
BALLS = {0.2: "quick", 0.14: "full", 0.1: "full"}  # m
EARLY, LATE = 0.05, 1.0  # T_v of the pressures that are compared


def modes():
    """The wave numbers of the layer."""
    return np.pi / 2 * (2 * np.arange(200) + 1)


def pressure(depth, factor):
    """Pressure over the load at a depth below the drained side, over the thickness."""
    m = modes()
    return (2 / m * np.sin(np.outer(depth, m)) * np.exp(-m**2 * factor)).sum(axis=1)


def degree(factor):
    """Degree of consolidation of the layer."""
    m = modes()
    return 1 - (2 / m**2 * np.exp(-m**2 * factor)).sum()


def ball_pressure(factor, eta=1.0):
    """Pressure in the middle of a ball over the load, in time c_v t / a^2; eta = (1 - nu) / (1 - 2 nu)."""
    def characteristic(x):
        return (1 - eta * x**2 / 2) * np.sin(x) - x * np.cos(x)
    roots = []
    x = np.linspace(1e-3, 200 * np.pi, 400001)
    values = characteristic(x)
    for k in np.flatnonzero(values[:-1] * values[1:] < 0):
        roots.append(scipy.optimize.brentq(characteristic, x[k], x[k + 1]))
    r = np.array(roots)
    weight = eta * (np.sin(r) - r) / (eta * r * np.cos(r) / 2 + (eta - 1) * np.sin(r))
    return (weight * np.exp(-np.outer(np.atleast_1d(factor), r**2))).sum(axis=1)


def frames(run, data, of):
    """(c_v t / a^2, frame) of a run of the `layer` or the `ball`, without the first."""
    diffusivity = data[f"permeability of the {of} [m/s]"] * data["modulus [Pa]"] / data["unit weight [N/m^3]"]
    return [(frame.time * diffusivity, frame) for frame in run.frames if frame.time > 0]


def error(run, data, factor):
    """Error of the pressure of particles at a T_v, root mean square over the load."""
    at, frame = min(frames(run, data, "layer"), key=lambda one: abs(one[0] - factor))
    return tools.rms(frame["pore_pressure"] / data["load [Pa]"] - pressure(1 - frame["position"][:, 1], at))


def consolidated(run, data, factor):
    """Degree of consolidation at a T_v, by the pressures, and that of the closed form at that time."""
    at, frame = min(frames(run, data, "layer"), key=lambda one: abs(one[0] - factor))
    mean = np.average(frame["pore_pressure"], weights=frame["volume"]) / data["load [Pa]"]
    return 1 - mean, degree(at)


def middle(run, data):
    """T_v and pressure over the load in the middle of a ball: a fit a + b r^2 to the particles within 0.35 m."""
    rows = []
    for at, frame in frames(run, data, "ball"):
        r = np.linalg.norm(frame["position"], axis=1)
        near = r < 0.35
        rows.append((at, np.polyfit(r[near]**2, frame["pore_pressure"][near], 1)[1] / data["load [Pa]"]))
    return np.array(rows).T


def layer_results(run, data, what):
    """Pressures early and late, and degrees of consolidation."""
    results = [
        tools.Result(CASE, f"error of the pressure at T_v = {factor:g}, {what}", "-", error(run, data, factor), "at most", data["slack of the pressure"], 0.0,
                     data["source of the layer"], run) for factor in (EARLY, LATE)]
    for factor in (0.2, 0.5):
        found, exact = consolidated(run, data, factor)
        results.append(tools.Result(CASE, f"degree of consolidation at T_v = {factor:g}, {what}", "-", found, "within", data["slack of the degree"], exact,
                                    data["source of the layer"], run))
    return results


def draw(figure, layers, balls, data):
    """Pressure over the depth of the finest layer, and over time in the middle of the balls."""
    left, right = figure.subplots(1, 2)
    depth = np.linspace(0, 1, 201)
    finest = layers[min(layers)]
    for at, frame in frames(finest, data, "layer"):
        if any(abs(at - factor) < 0.01 for factor in (0.05, 0.1, 0.2, 0.5, 1)):
            left.plot(frame["pore_pressure"] / data["load [Pa]"], frame["position"][:, 1], ".", markersize=1.5)
            left.plot(pressure(depth, at), 1 - depth, "k-", linewidth=0.7)
    left.set(xlabel="pore pressure over load", ylabel="height [m]")
    times = np.linspace(1e-3, 0.4, 200)
    right.plot(times, ball_pressure(times), "k-", linewidth=0.8, label="closed form")
    for size, run in balls.items():
        right.plot(*middle(run, data), "o-", markersize=2, label=f"cells of {size:g} m")
    right.set(xlabel="c_v t / a^2", ylabel="pressure in the middle over load")
    right.legend()


def evaluate(lab):
    """Results of the layer on several meshes, and of the ball."""
    data, results = tools.reference(CASE), []

    def layer(name, size, width, settings=None):
        return lab.run(f"{CASE}/layer.yaml", tools.label(f"{name}_{size}_{width}"),
                       {"mesh.size": size, "mesh.regions[0].shape.high": [width, 1], "bodies[0].shape.high": [width, 1], **(settings or {})})

    def wanted(*levels):
        return lab.level == "full" or all(level == "quick" for level in levels)

    layers = {(size, width): layer("layer", size, width) for size, at in SIZES.items() for width, also in WIDTHS.items() if wanted(at, also)}
    others = {kernel: layer(kernel, 0.05, 0.4, {"kernel": kernel, "transfer.scheme": scheme})
              for kernel, scheme in tools.SUITED.items() if kernel != "projected"}
    cut = {size: layer("cut", size, 0.4, {"mesh.regions[0].shape.high": [0.4, 1.17], "loads[0].on": "layer:y_max"})
           for size, at in SIZES.items() if wanted(at)}
    balls = {size: lab.run(f"{CASE}/ball.yaml", tools.label(f"ball_{size}"), {"mesh.size": size}) for size, at in BALLS.items() if wanted(at)}
    for (size, width), run in layers.items():
        if size < 0.1:
            results += layer_results(run, data, f"cells of {size:g} m, {width:g} m wide")
    for width in sorted({width for _, width in layers}):
        sizes = [size for size in SIZES if (size, width) in layers]
        results.append(tools.Result(CASE, f"order of the error at T_v = {EARLY:g}, {width:g} m wide", "-",
                                    tools.observed_order(sizes, [error(layers[size, width], data, EARLY) for size in sizes]), "at least", data["order asked"],
                                    2.0, "linear shape functions", layers[sizes[-1], width]))
    for kernel, run in others.items():
        results += layer_results(run, data, f"cells of 0.05 m, {kernel}")
    for size, run in cut.items():
        results.append(tools.Result(CASE, f"error of the pressure at T_v = {EARLY:g}, surface that cuts cells of {size:g} m", "-", error(run, data, EARLY),
                                    "reported", None, 0.0, "", run))
    for size, run in balls.items():
        at, found = middle(run, data)
        exact = ball_pressure(at)
        results.append(tools.Result(CASE, f"largest pressure in the middle of the ball over the load, cells of {size:g} m", "-", found.max(), "within",
                                    data["slack of the ball"], ball_pressure(np.linspace(0.01, 0.2, 500)).max(), data["source of the ball"], run))
        results.append(tools.Result(CASE, f"pressure in the middle of the ball, root mean square of the error, cells of {size:g} m", "-", tools.rms(found - exact),
                                    "reported", None, 0.0, "", run))
    lab.figure(CASE, "verification_consolidation", lambda figure: draw(figure, {s: layers[s, 0.4] for s in SIZES if (s, 0.4) in layers}, balls, data),
               size=(8, 3.6), caption="Pore pressure in a layer (dots: particles, lines: closed form) and in the middle of a ball.")
    return results
