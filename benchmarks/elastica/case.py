"""Elastica: a slender clamped beam under a dead load at its tip, at rest, against the beam theory of large rotations."""
import numpy as np

import fields
import lab as tools

CASE = "elastica"
LOADS = ["1", "2", "9.6"]  # P L^2 / (E' I), E' = E / (1 - nu^2)
PLAN = {"quick": [("1", 0.5), ("2", 0.5), ("9.6", 0.5), ("2", 0.35)],
        "full": [("1", 0.5), ("2", 0.5), ("9.6", 0.5), ("2", 0.35), ("1", 0.25), ("2", 0.25), ("9.6", 0.25)]}  # load, cell size [m]
OTHER = ("2", 0.5)  # load and cell size with another method as well
JUDGED = 0.35  # m, three cells over the height; two are reported
SHEAR = 5 / 6  # of the area of a rectangle that carries shear


def stiffness(data):
    """Bending [N m^2], stretching [N] and shearing stiffness [N] per width, plane strain."""
    plane = data["youngs_modulus [Pa]"] / (1 - data["poisson_ratio"]**2)
    height = data["height [m]"]
    return plane * height**3 / 12, plane * height, SHEAR * height * data["youngs_modulus [Pa]"] / (2 * (1 + data["poisson_ratio"]))


def force(load, data):
    """Dead load at the tip per width [N/m]."""
    return float(load) * stiffness(data)[0] / data["length [m]"]**2


def end(reach, load, softness, steps=400):
    """Where the tip comes to be (x, drop), over the length, if its x were `reach` in the moments; `softness`: load over stretching and shearing stiffness."""
    stretch, shear = softness

    def slope(state):
        x, _, angle = state
        along, across = 1 + stretch * np.sin(angle), shear * np.cos(angle)
        return np.array([along * np.cos(angle) - across * np.sin(angle), along * np.sin(angle) + across * np.cos(angle), load * (reach - x)])

    state, step = np.zeros(3), 1 / steps
    for _ in range(steps):  # Runge-Kutta, fourth order
        first = slope(state)
        second = slope(state + step / 2 * first)
        third = slope(state + step / 2 * second)
        state = state + step / 6 * (first + 2 * second + 2 * third + slope(state + step * third))
    return state[:2]


def beam(load, softness=(0, 0)):
    """Drop and shortening of the tip over the length, the reach found by bisection; without softness the elastica."""
    low, high = 0.0, 1.1
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if end(middle, load, softness)[0] > middle else (low, middle)
    x, drop = end(middle, load, softness)
    return float(drop), float(1 - x)


def theory(load, data):
    """Drop and shortening over the length, with shear and stretch."""
    _, stretching, shearing = stiffness(data)
    return beam(float(load), (force(load, data) / stretching, force(load, data) / shearing))


def tip(run, data):
    """Drop and shortening of the middle of the free end over the length: a linear field fitted to the particles nearest to it."""
    frame, at = run.last_frame(), np.array([data["length [m]"], data["height [m]"] / 2])
    start = frame["position"][:, :2] - frame["displacement"][:, :2]
    moved = fields.extended(start, frame["displacement"][:, :2], at)
    return float(-moved[1] / data["length [m]"]), float(-moved[0] / data["length [m]"])


def draw(figure, runs, data):
    """Left shapes of the beams, right drop and shortening over the load."""
    left, right = figure.subplots(1, 2)
    for load in LOADS:
        frame = runs[load, 0.5].last_frame()
        left.plot(frame["position"][:, 0], frame["position"][:, 1], ".", markersize=2, label=f"{load}")
    loads = np.linspace(0.3, 10, 25)
    curves = np.array([theory(load, data) for load in loads])
    for part, name in enumerate(("drop", "shortening")):
        right.plot(loads, curves[:, part], color=f"C{part}", label=f"{name}, beam theory")
        right.plot([float(load) for load, _ in runs], [tip(run, data)[part] for run in runs.values()], "o", fillstyle="none", color=f"C{part}", label=f"{name}, talus")
    left.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
    left.legend(title="P L$^2$ / (E' I)", fontsize=7)
    right.set(xlabel="P L$^2$ / (E' I)", ylabel="displacement of the tip / length [-]")
    right.legend(fontsize=7)


def settings(load, size, data):
    """Changes to the scene for a load and cells of `size` [m]."""
    return {"mesh.size": size, "loads[0].traction": [0, -round(force(load, data) / data["height [m]"], 6)]}


def judge(name, load, size, run, data):
    """Results of one run."""
    drop, shortening = tip(run, data)
    asked = ("within", data["slack"]) if size <= JUDGED else ("reported", None)
    plain, source = data["elastica"][load], f"{data['source']}; {data['elastica source']}"
    full = theory(load, data)
    return [tools.Result(CASE, f"drop of the tip over the length, {name}", "-", drop, *asked, full[0], source, run),
            tools.Result(CASE, f"shortening over the length, {name}", "-", shortening, "reported", None, full[1], source, run),
            tools.Result(CASE, f"drop over that of the elastica, {name}", "-", drop / plain[0], "reported", None, 1.0, data["elastica source"], run)]


def evaluate(lab):
    """Three loads, two or three meshes."""
    data = tools.reference(CASE)
    runs = {(load, size): lab.run(f"{CASE}/scene.yaml", f"load{load}_dx{size}",
                                  settings(load, size, data)) for load, size in PLAN[lab.level]}
    sizes = sorted({size for load, size in runs if load == "2"}, reverse=True)
    lab.convergence(CASE, "relative error of the drop, load 2", sizes, [abs(tip(runs["2", size], data)[0] / theory("2", data)[0] - 1) for size in sizes])
    lab.figure(CASE, "verification_elastica", lambda figure: draw(figure, runs, data), size=(7.6, 3.2),
               caption="Slender beams under dead loads at their tips, at rest, and the theory of beams with large rotations.")
    load, size = OTHER
    beside = lab.run(f"{CASE}/scene.yaml", f"projected_load{load}_dx{size}", {**settings(load, size, data), **tools.METHODS["projected, aflip"]})
    results = [result for (load, size), run in runs.items() for result in judge(f"load {load}, cells of {size} m", load, size, run, data)]
    return results + [result for name, run in tools.ends({f"load {load}, cells of {size} m, projected, aflip": beside}).items()
                      for result in judge(name, load, size, run, data)]
