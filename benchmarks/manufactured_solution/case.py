"""Manufactured solution: displacement along the axes in a bar, a square and a cube, driven by a body force given by formulas."""
import numpy as np

import lab as tools

CASE = "manufactured_solution"
SIGNS = [1, -1, -1]  # phases 0, pi, pi: nothing is displaced at the start
# name: scene, Poisson's ratio, axes that move, amplitudes [m]
PROBLEMS = {"bar": ("scene_bar.yaml", 0, 1, [0.05, 0.0001]), "square": ("scene.yaml", 0.3, 2, [0.1, 0.0001]), "cube": ("scene_cube.yaml", 0.3, 3, [0.1]),
            "ring": ("scene_ring.yaml", 0, 2, [0.1])}
RING = (0.4, 0.6, 0.5)  # m, radii: inside, outside, and where the amplitude is that of the problem
METHODS = {kernel: tools.METHODS[f"{kernel}, {scheme}"] for kernel, scheme in tools.SUITED.items()} | {"projected, saflip": tools.CHOICES["projected, saflip"]}
CHOSEN = ("square", "ring")  # problems that saflip is run on, with the large amplitude
JUDGED = {"bar": 0.05, "square": 0.1, "cube": 0.1}  # amplitude at which the order is asked of all kernels but linear


def counts(problem, kernel, amplitude, level):
    """Cells along an edge of 1 m."""
    if level == "quick":
        fine = kernel != "linear" and amplitude == 0.1
        return {"bar": [8, 16, 32], "square": [8, 16, 32] if fine else [8, 16], "cube": [3, 6], "ring": [20, 40]}[problem]
    return {"bar": [8, 16, 32, 64], "square": [8, 16, 32, 64] if kernel != "linear" else [8, 16, 32], "cube": [3, 6, 12], "ring": [20, 40, 80]}[problem]


def formulas(problem, amplitude, data):
    """Initial velocity [m/s] and force per mass [m/s^2] as formulas of a scene: k^2 u {mu/rho - c^2 - [lambda (ln J - 1) - mu] / (rho F^2)}."""
    _, nu, axes, _ = PROBLEMS[problem]
    speed = np.sqrt(data["modulus [Pa]"] / data["density [kg/m^3]"])
    square_p = data["modulus [Pa]"] * nu / ((1 + nu) * (1 - 2 * nu)) / data["density [kg/m^3]"]  # lambda / rho
    square_s = data["modulus [Pa]"] / (2 * (1 + nu)) / data["density [kg/m^3]"]  # mu / rho
    sine = f"sin({speed:.17g} * pi * t)"
    heights = [sign * amplitude for sign in SIGNS[:axes]]
    stretches = [f"(1 + {height:.17g} * pi * cos(pi * {axis}) * {sine})" for axis, height in zip("xyz", heights)]
    volume = f"ln({' * '.join(stretches)})"
    idle = ["0"] * (max(axes, 2) - axes)
    velocity = [f"{height * speed:.17g} * pi * sin(pi * {axis})" for axis, height in zip("xyz", heights)]
    force = [f"pi^2 * {height:.17g} * sin(pi * {axis}) * {sine} * "
             f"({square_s - speed**2:.17g} - ({square_p:.17g} * ({volume} - 1) - {square_s:.17g}) / {stretch}^2)"
             for axis, height, stretch in zip("xyz", heights, stretches)]
    return velocity + idle, force + idle


def swell(radius):
    """The form q(R) of the ring's swing and its first and second derivative: no stretch along the radius at both surfaces, 1 in between."""
    inside, outside, middle = RING

    def form(at):
        return at**3 / 3 - (inside + outside) / 2 * at**2 + inside * outside * at

    size = form(middle)
    return form(radius) / size, (radius - inside) * (radius - outside) / size, (2 * radius - inside - outside) / size


def ring_formulas(amplitude, data):
    """The same of the ring, u_R = A q(R) sin(pi c t), nu = 0: with F_r = 1 + u', F_t = 1 + u / R the force along the radius is

    u.. - mu/rho [ (1 + 1 / F_r^2) u'' + (F_r - 1 / F_r - F_t + 1 / F_t) / R ].
    """
    speed, square_s = np.sqrt(data["modulus [Pa]"] / data["density [kg/m^3]"]), data["modulus [Pa]"] / 2 / data["density [kg/m^3]"]
    inside, outside, middle = RING
    size = middle**3 / 3 - (inside + outside) / 2 * middle**2 + inside * outside * middle
    radius, sine = "sqrt(x^2 + y^2)", f"sin({speed:.17g} * pi * t)"
    form = f"({1 / (3 * size):.17g} * {radius}^3 - {(inside + outside) / (2 * size):.17g} * {radius}^2 + {inside * outside / size:.17g} * {radius})"
    slope = f"({1 / size:.17g} * ({radius} - {inside}) * ({radius} - {outside}))"
    bend = f"({1 / size:.17g} * (2 * {radius} - {inside + outside:.17g}))"
    stretch, hoop = f"(1 + {amplitude:.17g} * {sine} * {slope})", f"(1 + {amplitude:.17g} * {sine} * {form} / {radius})"
    force = (f"(-{(speed * np.pi)**2:.17g} * {amplitude:.17g} * {sine} * {form} - {square_s:.17g} * ((1 + 1 / {stretch}^2) * {amplitude:.17g} * {sine} * "
             f"{bend} + ({stretch} - 1 / {stretch} - {hoop} + 1 / {hoop}) / {radius}))")
    return [f"{amplitude * speed:.17g} * pi * {form} * {axis} / {radius}" for axis in "xy"], [f"{force} * {axis} / {radius}" for axis in "xy"]


def start(lab, problem, kernel, amplitude, count, data):
    """Starts one run."""
    velocity, force = ring_formulas(amplitude, data) if problem == "ring" else formulas(problem, amplitude, data)
    mesh = {"mesh.grid.cells": [count, 2], "mesh.grid.high": [1, 2 / count], "bodies[0].shape.high": [1, 2 / count]} if problem == "bar" else {
        "mesh.size": 1 / count}
    return lab.run(f"{CASE}/{PROBLEMS[problem][0]}", f"{problem}_{tools.label(kernel)}_G{amplitude:g}_{count}", {
        **mesh, **METHODS[kernel], "bodies[0].velocity": velocity, "loads[0].acceleration": force})


def error(run, problem, amplitude, data):
    """Largest over the times: root of the mean over the mass of the square of the error in displacement, relative to the amplitude."""
    axes, omega = PROBLEMS[problem][2], np.pi * np.sqrt(data["modulus [Pa]"] / data["density [kg/m^3]"])
    largest = 0.0
    for frame, time in zip(run.frames, run.frames.times):
        moved = frame["displacement"].astype(float)
        exact, place = np.zeros_like(moved), (frame["position"] - moved)[:, :axes]
        if problem == "ring":
            radius = np.linalg.norm(place, axis=1, keepdims=True)
            exact[:, :axes] = amplitude * np.sin(omega * time) * swell(radius)[0] * place / radius
        else:
            exact[:, :axes] = amplitude * np.sin(omega * time) * np.array(SIGNS[:axes]) * np.sin(np.pi * place)
        largest = max(largest, np.sqrt(np.average(np.sum((moved - exact)**2, axis=1), weights=frame["mass"])) / amplitude)
    return float(largest)


def judge(lab, key, runs, data):
    """Results of one sweep of sizes; `key` is problem, kernel, amplitude."""
    problem, kernel, amplitude = key
    sizes, errors = [1 / count for count in runs], [error(run, problem, amplitude, data) for run in runs.values()]
    name = f"{problem}, {kernel}, G = {amplitude:g} m"
    published = {label: dict(map(tuple, rows)) for label, rows in data["published"].get(problem, {}).get(f"{amplitude:g}", {}).items()}
    judged = kernel != "linear" and JUDGED.get(problem) == amplitude
    results = []
    for (count, run), value in zip(runs.items(), errors):
        asked = judged and problem == "square" and count == 32
        closest = published.get("MPM, linear" if kernel == "linear" else "iMPM", {}).get(count)
        source = data["largest error at 1/32"]["source"] if asked else data["source"]
        results.append(tools.Result(CASE, f"displacement error over G, {name}, 1/h = {count}", "-", value, "at most" if asked else "reported",
                                    data["largest error at 1/32"]["value"] if asked else None, closest / amplitude if closest else 0.0, source, run))
    results.append(tools.Result(CASE, f"order of convergence, {name}", "-", tools.observed_order(sizes, errors), "at least" if judged else "reported",
                                data["order"]["asked"] if judged else None, data["order"]["value"], data["order"]["source"], runs[max(runs)]))
    lab.convergence(CASE, f"displacement error, {name}", sizes, errors, expected=2)
    return results, (sizes, errors)


def draw(figure, curves, data):
    """Error over size: bar, square and cube at the large amplitude, beside what was published."""
    panels = [("bar", 0.05), ("square", 0.1), ("square", 0.0001), ("cube", 0.1)]
    for axis, (problem, amplitude) in zip(figure.subplots(1, len(panels), sharey=True), panels):
        for label, rows in data["published"].get(problem, {}).get(f"{amplitude:g}", {}).items():
            count, value = np.array(rows).T
            axis.loglog(1 / count, value / amplitude * 100, ":", color="0.5" if "linear" in label else "0.2" if label == "iMPM" else "0.7", label=label)
        for kernel, mark in (("umls", "o-"), ("linear", "s--"), ("projected", "^-"), ("projected, saflip", "v-")):
            if (problem, kernel, amplitude) in curves:
                sizes, errors = curves[problem, kernel, amplitude]
                axis.loglog(sizes, np.array(errors) * 100, mark, label=f"talus, {kernel}")
        tools.size_axis(axis, [0.125, 0.0625, 0.03125] if problem != "cube" else [0.333, 0.167])
        axis.set(title=f"{problem}, G = {amplitude:g} m")
        axis.legend(fontsize=6)
    figure.axes[0].set_ylabel("error in displacement [% of G]")


def evaluate(lab):
    """Results of all problems, kernels and amplitudes; judged are the orders of umls and projected at the large amplitude and their errors in the square at 1/h = 32."""
    data, results, curves = tools.reference(CASE), [], {}
    plan = {(problem, kernel, amplitude): {count: start(lab, problem, kernel, amplitude, count, data) for count in counts(problem, kernel, amplitude, lab.level)}
            for problem, (_, _, _, amplitudes) in PROBLEMS.items() for amplitude in amplitudes for kernel in METHODS
            if kernel in tools.SUITED or (problem in CHOSEN and amplitude == 0.1)}
    for key, runs in plan.items():
        found, curves[key] = judge(lab, key, runs, data)
        results += found
    lab.figure(CASE, "verification_manufactured", lambda figure: draw(figure, curves, data), size=(9.6, 3.2),
               caption="Error of manufactured solutions beside published ones: MPM with linear shape functions, MPM with moving least squares (iMPM), finite elements.")
    return results


def tradeoff(lab):
    """The square at the large amplitude, strain up to 31 %: particles cross cells; the error is that of evaluate()."""
    data = tools.reference(CASE)
    velocity, force = formulas("square", 0.1, data)
    swept = [8, 16, 32] if lab.level == "quick" else [8, 16, 32, 64]
    return tools.Tradeoff(
        scene=f"{CASE}/scene.yaml",
        axes={"mesh": {f"1/h = {count}": {"mesh.size": 1 / count} for count in swept},
              "particles": {f"{count} particles": {"bodies[0].particles_per_cell": count} for count in (6, 3, 12)},
              "method": {**tools.METHODS, "linear, tpic": {"kernel": "linear", "transfer.scheme": "tpic"}},
              "step": {f"CFL {share}": {"time.cfl": share} for share in (0.4, 0.8, 0.2)}},
        error=lambda run: error(run, "square", 0.1, data),
        what="error in displacement of the manufactured solution in a square",
        settings={"bodies[0].velocity": velocity, "loads[0].acceleration": force})
