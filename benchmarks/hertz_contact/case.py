"""An elastic ball bounces off a rigid plane: largest force and duration of the contact against Hertz, on meshes refined at the contact."""
import numpy as np

import lab as tools

CASE = "hertz_contact"
SIZES = {"quick": [0.12, 0.06], "full": [0.12, 0.06, 0.03]}  # m, cells at the contact
JUDGED = "full"  # the level at which the finest mesh has a verdict
OTHERS = ("projected, aflip", "projected, saflip", "umls, exact_force, aflip")  # beside the kernel and transfer of the scene
TOUCH = 0.01  # of Hertz's largest force: what counts as contact


def hertz(data, mass):
    """Deepest approach [m], largest force on the whole ball [N] and duration of the contact [s] for a ball of `mass` [kg]."""
    stiffness = 4 / 3 * data["youngs_modulus [Pa]"] / (1 - data["poisson_ratio"]**2) * np.sqrt(data["radius [m]"])
    speed = data["speed [m/s]"]
    depth = (5 / 4 * mass * speed**2 / stiffness)**0.4  # m v^2 / 2 = 2/5 stiffness depth^2.5
    return depth, stiffness * depth**1.5, 2.943275 * depth / speed


def force_history(time, duration):
    """Hertz's force over the largest one at `time` [s] after first contact: the motion integrated from rest at the deepest place, both ways."""
    unit = np.linspace(0, 1, 20001)[:-1]  # depth over the deepest
    slow = np.concatenate([[0], np.cumsum(np.diff(unit) / np.sqrt(1 - ((unit[1:] + unit[:-1]) / 2)**2.5))])
    passed = slow / slow[-1] * duration / 2
    return np.interp(np.minimum(time, duration - time), passed, unit**1.5)


def wall_force(run):
    """Force of the plane on the whole ball [N], four times that on the quarter."""
    return 4 * np.abs(run.history["reaction_z_min_z"])


def measures(run, data):
    """Largest force and duration of contact over those of Hertz, rebound speed over approach speed, energy at the end over that at the start."""
    history, mass = run.history, 4 * run.history["mass"][0]  # that of the particles, 0.2 to 2 % off that of the ball
    _, largest, duration = hertz(data, mass)
    force = wall_force(run)
    touching = history["time"][force > TOUCH * largest]
    return (float(force.max() / largest), float((touching[-1] - touching[0]) / duration),
            float(4 * history["momentum_z"][-1] / mass / data["speed [m/s]"]),
            float((history["kinetic"][-1] + history["strain"][-1]) / history["kinetic"][0]))


def draw(figure, runs, data):
    """Force over time; Hertz begins where the ball touches the plane."""
    axis = figure.subplots()
    _, largest, duration = hertz(data, 4 / 3 * np.pi * data["density [kg/m^3]"] * data["radius [m]"]**3)
    time = np.linspace(0, duration, 200)
    axis.plot(time + data["gap [m]"] / data["speed [m/s]"], largest * force_history(time, duration), "k", label="Hertz")
    for size, run in runs.items():
        axis.plot(run.history["time"], wall_force(run), label=f"talus, cells of {size} m")
    axis.set(xlabel="time [s]", ylabel="force of the plane [N]")
    axis.legend()


def judge(name, run, data, judged):
    """Results of one run; the finest mesh of the full level is asked for what it is built for."""
    force, duration, rebound, energy = measures(run, data)
    asked = ("within", data["slack"]) if judged else ("reported", None)
    source = data["source"]
    return [
        tools.Result(CASE, f"largest force over Hertz's, {name}", "-", force, *asked, 1.0, source, run),
        tools.Result(CASE, f"duration of the contact over Hertz's, {name}", "-", duration, *asked, 1.0, source, run),
        tools.Result(CASE, f"rebound speed over approach speed, {name}", "-", rebound, "reported", None, 1.0, "Hertz: no energy is lost to waves", run),
        tools.Result(CASE, f"energy at the end over that at the start, {name}", "-", energy, "reported", None, 1.0, "conserved by the exact solution", run)]


def refined(size):
    """Changes to the scene for cells of `size` [m] at the contact."""
    return {"mesh.refine[0].size": size, "mesh.refine[1].size": 2 * size}


def evaluate(lab):
    """Two or three meshes, refined twice towards the contact."""
    data, sizes = tools.reference(CASE), SIZES[lab.level]
    runs = {size: lab.run(f"{CASE}/scene.yaml", f"dx{size}", refined(size)) for size in sizes}
    beside = {(method, size): lab.run(f"{CASE}/scene.yaml", tools.label(f"{method}_dx{size}"), {**refined(size), **tools.CHOICES[method]})
              for method in OTHERS for size in (sizes if lab.level == "full" else sizes[:1])}
    lab.convergence(CASE, "error of the largest force", sizes, [abs(measures(runs[size], data)[0] - 1) for size in sizes])
    lab.convergence(CASE, "error of the duration of the contact", sizes, [abs(measures(runs[size], data)[1] - 1) for size in sizes])
    lab.figure(CASE, "verification_hertz", lambda figure: draw(figure, runs, data), caption="Force of a rigid plane on an elastic ball.")
    named = {f"cells of {size} m": (size, run) for size, run in runs.items()} | {f"cells of {size} m, {method}": (size, run) for (method, size), run in beside.items()}
    return [result for name, (size, run) in named.items() for result in judge(name, run, data, lab.level == JUDGED and size == sizes[-1])]
