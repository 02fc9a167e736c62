"""Consolidation: a layer that drains to one side (Terzaghi), also under its own weight, a plate (Mandel) and a ball (Cryer), in which pressures rise first."""
import functools

import numpy as np
import scipy.optimize

import lab as tools

CASE = "consolidation"
SIZES = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # m
WIDTHS = {0.4: "quick", 0.41: "full", 0.42: "full"}  # m: gmsh then makes other triangles
BALLS = {0.2: "quick", 0.14: "full", 0.1: "full"}  # m
PLATES = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # m
HEIGHTS = {0.4: "quick", 0.41: "full", 0.42: "full"}  # m, of the plate
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


def weight_pressure(depth, factor):
    """Excess pressure under its own weight over the first one at the base, at a depth over the thickness: the first one grows with the depth."""
    m = modes()
    return (2 / m**2 * (-1.0) ** np.arange(len(m)) * np.sin(np.outer(depth, m)) * np.exp(-m**2 * factor)).sum(axis=1)


class Plate:
    """Closed form of Mandel's plate of half the width 1 m, under the load F over its half width, and the motion of the stiff plate on it.

    With the same vertical strain e everywhere and no lateral force, M u_x' = p + lambda e, so that p_t = c p_xx + 2 G e_t with p = 0 at x = 1:
    this gives the pressure also under the motion of the run, which begins with a ramp.
    """

    def __init__(self, data):
        modulus, nu = data["modulus [Pa]"], data["Poisson's ratio of the plate"]
        self.load, self.ramp, self.nu = data["load [Pa]"], data["ramp of the plate [s]"], nu
        self.shear = modulus / 2 / (1 + nu)
        self.diffusivity = data["permeability of the plate [m/s]"] * modulus * (1 - nu) / (1 + nu) / (1 - 2 * nu) / data["unit weight [N/m^3]"]
        eta = 2 * (1 - nu) / (1 - 2 * nu)
        self.roots = np.array([scipy.optimize.brentq(lambda a: np.sin(a) - eta * a * np.cos(a), k * np.pi + 1e-3, (k + 0.5) * np.pi) for k in range(1000)])
        self.weights = np.sin(self.roots) / (self.roots - np.sin(self.roots) * np.cos(self.roots))

    def pressure(self, x, time):
        """Pressure over the load under a force that is whole from the start."""
        shape = np.cos(np.outer(x, self.roots)) - np.cos(self.roots)
        return shape @ (self.weights * np.exp(-self.roots**2 * self.diffusivity * time))

    def strain(self, times):
        """Vertical strain under that force, positive in compression."""
        decay = np.exp(-np.outer(np.atleast_1d(times), self.roots**2) * self.diffusivity)
        return self.load / self.shear * ((1 - self.nu) / 2 - decay @ (self.weights * np.cos(self.roots)) / 2)

    @functools.cached_property
    def motion(self):
        """Times and rates of strain [1/s]: those of the closed form after the ramp, over which the strain grows by sin^2."""
        times = np.concatenate([np.linspace(0, self.ramp, 41), self.ramp * np.geomspace(1, 60, 81)[1:]])

        def strain(t):
            return np.where(t < self.ramp, np.sin(np.pi / 2 * np.minimum(t, self.ramp) / self.ramp) ** 2, 1) * self.strain(t)
        rates = (strain(times + 1e-7) - strain(np.maximum(times - 1e-7, 0))) / 2e-7
        rates[0] = 0
        return times, rates

    def table(self, height):
        """The motion as factors of the velocity in the scene, which is half of that of the stiff plate, as of a wave that comes up."""
        return [[float(f"{t:.6g}"), float(f"{rate * height / 2 / 4e-4:.6g}")] for t, rate in zip(*self.motion)]

    def followed(self, x, time):
        """Pressure over the load under the motion of the run."""
        m = modes()
        steps = np.union1d(np.linspace(0, min(self.ramp, time), 400), np.linspace(min(self.ramp, time), time, 2000))
        rates, growth = 2 * self.shear * np.interp(steps, *self.motion), np.zeros(len(m))
        for i, step in enumerate(np.diff(steps)):
            decay = np.exp(-m**2 * self.diffusivity * step)
            growth = growth * decay + (rates[i] + rates[i + 1]) / 2 * (1 - decay) / (m**2 * self.diffusivity)
        return np.cos(np.outer(x, m)) @ (growth * 2 / m * (-1.0) ** np.arange(len(m))) / self.load


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


def weight_error(run, data, factor):
    """Error of the excess pressure of particles at a T_v, root mean square over the first one at the base."""
    at, frame = min(frames(run, data, "layer"), key=lambda one: abs(one[0] - factor))
    depth = 1 - frame["position"][:, 1]
    first = data["density of the layer [kg/m^3]"] * data["gravity [m/s^2]"] - data["unit weight [N/m^3]"]
    return tools.rms((frame["pore_pressure"] - data["unit weight [N/m^3]"] * depth) / first - weight_pressure(depth, at))


def plate_errors(run, closed, factor):
    """Errors of the pressure at a c_v t / a^2 over the load: to the closed form under the motion of the run, and to that under a force from the start."""
    frame = min(run.frames, key=lambda one: abs(one.time * closed.diffusivity - factor))
    x, pressure = frame["position"][:, 0], frame["pore_pressure"] / closed.load
    return tools.rms(pressure - closed.followed(x, frame.time)), tools.rms(pressure - closed.pressure(x, frame.time))


def plate_middle(run, closed):
    """c_v t / a^2 and pressure over the load in the middle of the plate: a fit a + b x^2 to the particles within 0.25 m."""
    rows = []
    for frame in run.frames:
        x = frame["position"][:, 0]
        rows.append((frame.time * closed.diffusivity, np.polyfit(x[x < 0.25] ** 2, frame["pore_pressure"][x < 0.25] / closed.load, 1)[1]))
    return np.array(rows).T


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


def weight_results(runs, data):
    """Errors of the layers {(size, width): run} under their own weight, and their order."""
    results = []
    for (size, width), run in runs.items():
        if size < 0.1:
            results += [tools.Result(CASE, f"own weight: error of the excess pressure at T_v = {factor:g}, cells of {size:g} m, {width:g} m wide", "-",
                                     weight_error(run, data, factor), "at most", data["slack of the pressure"], 0.0,
                                     data["source of the layer under its own weight"], run)
                        for factor in (EARLY, LATE)]
    for width in sorted({width for _, width in runs}):
        sizes = [size for size in SIZES if (size, width) in runs]
        results.append(tools.Result(CASE, f"own weight: order of the error at T_v = {EARLY:g}, {width:g} m wide", "-",
                                    tools.observed_order(sizes, [weight_error(runs[size, width], data, EARLY) for size in sizes]), "at least",
                                    data["order asked"], 2.0, "linear shape functions", runs[sizes[-1], width]))
    return results


def plate_results(runs, closed, data):
    """Pressures of the plates {(size, height): run}, their largest value in the middle, the force on the stiff plate, and the order."""
    results, source, errors = [], data["source of the plate"], {key: plate_errors(run, closed, 0.1) for key, run in runs.items()}
    largest = closed.pressure(np.zeros(1), 1e-9)[0], max(closed.pressure(np.zeros(1), t / closed.diffusivity)[0] for t in np.linspace(0.02, 0.2, 100))
    for (size, height), run in runs.items():
        name, history = f"cells of {size:g} m, {height:g} m high", run.history
        later = history["time"] * closed.diffusivity > EARLY
        force = -history["reaction_y_max_y"][later] / closed.load
        judged = {"criterion": "at most", "tolerance": data["slack of the pressure"]} if size < 0.1 else {"criterion": "reported", "tolerance": None}
        near = {"criterion": "within", "tolerance": data["slack of the degree"]} if size < 0.1 else {"criterion": "reported", "tolerance": None}
        results += [
            tools.Result(CASE, f"plate: error of the pressure at c_v t / a^2 = 0.1, {name}", "-", errors[size, height][0], reference=0.0, source=source,
                         run=run, **judged),
            tools.Result(CASE, f"plate: the same under a force that is whole from the start, {name}", "-", errors[size, height][1], reference=0.0, source=source,
                         run=run, **judged),
            tools.Result(CASE, f"plate: largest pressure in the middle over the load, {name}", "-", plate_middle(run, closed)[1].max(),
                         reference=float(largest[1]), source=source, run=run, **near),
            tools.Result(CASE, f"plate: mean force on the stiff plate over that of the closed form, {name}", "-", float(force.mean()), reference=1.0,
                         source=source, run=run, **near)]
    for height in sorted({height for _, height in runs}):
        sizes = [size for size in PLATES if (size, height) in runs]
        results.append(tools.Result(CASE, f"plate: order of the error of the pressure, {height:g} m high", "-",
                                    tools.observed_order(sizes, [errors[size, height][0] for size in sizes]), "at least", data["order asked"], 2.0,
                                    "linear shape functions", runs[sizes[-1], height]))
    return results


def draw_more(figure, weights, plates, closed, data):
    """Excess pressure over the depth of the finest layer under its own weight, and pressure over time in the middle of the plates."""
    left, right = figure.subplots(1, 2)
    depth, unit = np.linspace(0, 1, 201), data["unit weight [N/m^3]"]
    first = data["density of the layer [kg/m^3]"] * data["gravity [m/s^2]"] - unit
    for at, frame in frames(weights[min(weights)], data, "layer"):
        if any(abs(at - factor) < 0.01 for factor in (0.05, 0.1, 0.2, 0.5, 1)):
            height = frame["position"][:, 1]
            left.plot((frame["pore_pressure"] - unit * (1 - height)) / first, height, ".", markersize=1.5)
            left.plot(weight_pressure(depth, at), 1 - depth, "k-", linewidth=0.7)
    left.set(xlabel="excess pressure over that of the base at the start", ylabel="height [m]")
    times = np.linspace(1e-4, 0.16, 200)
    right.plot(times, [closed.pressure(np.zeros(1), t / closed.diffusivity)[0] for t in times], "k-", linewidth=0.8, label="closed form")
    for size, run in plates.items():
        right.plot(*plate_middle(run, closed), "o-", markersize=2, linewidth=0.6, label=f"cells of {size:g} m")
    right.set(xlabel="c_v t / a^2", ylabel="pressure in the middle of the plate over load", ylim=(0.3, 0.6))
    right.legend()


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

    closed = Plate(data)

    def layer(name, size, width, settings=None, scene="layer"):
        return lab.run(f"{CASE}/{scene}.yaml", tools.label(f"{name}_{size}_{width}"),
                       {"mesh.size": size, "mesh.regions[0].shape.high": [width, 1], "bodies[0].shape.high": [width, 1], **(settings or {})})

    def wanted(*levels):
        return lab.level == "full" or all(level == "quick" for level in levels)

    layers = {(size, width): layer("layer", size, width) for size, at in SIZES.items() for width, also in WIDTHS.items() if wanted(at, also)}
    others = {kernel: layer(kernel, 0.05, 0.4, {"kernel": kernel, "transfer.scheme": scheme})
              for kernel, scheme in tools.SUITED.items() if kernel != "projected"}
    cut = {size: layer("cut", size, 0.4, {"mesh.regions[0].shape.high": [0.4, 1.17], "loads[0].on": "layer:y_max"})
           for size, at in SIZES.items() if wanted(at)}
    balls = {size: lab.run(f"{CASE}/ball.yaml", tools.label(f"ball_{size}"), {"mesh.size": size}) for size, at in BALLS.items() if wanted(at)}
    weights = {(size, width): layer("weight", size, width, scene="self_weight")
               for size, at in SIZES.items() for width, also in WIDTHS.items() if wanted(at, also) and (size > 0.03 or width == 0.4)}
    plates = {(size, height): lab.run(f"{CASE}/mandel.yaml", tools.label(f"plate_{size}_{height}"), {
        "mesh.size": size, "mesh.regions[0].shape.high": [1, height], "bodies[0].shape.high": [1, height], "boundaries[2].table": closed.table(height)})
              for size, at in PLATES.items() for height, also in HEIGHTS.items() if wanted(at, also) and (size > 0.03 or height == 0.4)}
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
    results += weight_results(weights, data) + plate_results(plates, closed, data)
    lab.figure(CASE, "verification_consolidation_more", lambda figure: draw_more(
        figure, {s: weights[s, 0.4] for s in SIZES if (s, 0.4) in weights}, {s: plates[s, 0.4] for s in PLATES if (s, 0.4) in plates}, closed, data),
               size=(8, 3.6), caption="Excess pore pressure in a layer under its own weight (dots: particles, lines: closed form) and in the middle of Mandel's plate.")
    lab.figure(CASE, "verification_consolidation", lambda figure: draw(figure, {s: layers[s, 0.4] for s in SIZES if (s, 0.4) in layers}, balls, data),
               size=(8, 3.6), caption="Pore pressure in a layer (dots: particles, lines: closed form) and in the middle of a ball.")
    return results
