"""Bodies with velocity fields of their own: a disk or sphere that rolls or slides down an inclined body, and two disks that collide."""
import numpy as np

import lab as tools

CASE = "contact"
INCLINES = {"rolls, friction 0.3, 30 degrees": (0.3, 30), "slides, friction 0.1, 30 degrees": (0.1, 30), "slides, friction 0.3, 60 degrees": (0.3, 60)}
SIZES = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # 5, 10 and 20 cells over the radius
PLACES = {0.0: "quick", -0.03: "full", -0.06: "full"}  # m, left end of the room: gmsh then makes other meshes
SPHERES = (0.1, 0.07)  # m, at full level: 5 and 7 cells over the radius
MODULI = {"plane as soft as the disk": (1e6, 1e6), "both ten times as stiff": (1e7, 1e8)}  # Pa, at full level: of disk and plane
ROLLS = "rolls, friction 0.3, 30 degrees"
DISKS = {0.05: "quick", 0.025: "quick", 0.0125: "full"}


def acceleration(friction, degrees, gravity, turning=1.5):
    """Of a rigid body down the plane [m/s^2]; `turning` is 1 plus its moment of inertia over mass and square of the radius, 1.5 for a disk."""
    angle = np.radians(degrees)
    if np.tan(angle) < friction * turning / (turning - 1):
        return gravity * np.sin(angle) / turning
    return gravity * (np.sin(angle) - friction * np.cos(angle))


def run_down(lab, case, friction_key, name, size, place, data, more=None, word=""):
    """Starts a run of the scene of a case down a plane, with `more` settings under a label that ends with `word`."""
    friction, degrees = INCLINES[name]
    angle, gravity = np.radians(degrees), data["gravity [m/s^2]"]
    settings = {friction_key: friction, "loads[0].acceleration": [float(gravity * np.sin(angle)), float(-gravity * np.cos(angle))],
                "mesh.size": size, **{f"mesh.regions[{i}].shape.low": [place, bottom] for i, bottom in enumerate(data["bottoms of regions [m]"])}}
    return lab.run(f"{case}/scene.yaml", tools.label(f"{name}_{size}_{-place}{word}"), {**settings, **(more or {})})


def runs_down(lab, case, friction_key, data):
    """Starts the runs of this level, by incline, size of cells and place of the mesh."""
    return {(name, size, place): run_down(lab, case, friction_key, name, size, place, data) for name in INCLINES for size in SIZES for place in PLACES
            if lab.level == "full" or {SIZES[size], PLACES[place]} == {"quick"}}


def runs_down_of_kernel(lab, case, friction_key, data):
    """The same with another kernel: on all places with the coarse cells, on the first with the middle ones."""
    return {(name, size, place): run_down(lab, case, friction_key, name, size, place, data) for name in INCLINES for size, place in
            [(0.1, place) for place in PLACES] + [(0.05, 0.0)]}


def way(run, data):
    """How far the middle of the disk has come [m]."""
    return run.history["middle_x"] - data["start [m]"]


def judge_incline(name, size, place, run, data):
    """The way at the end, relative to that of a rigid disk."""
    time = run.history["time"][-1]
    exact = acceleration(*INCLINES[name], data["gravity [m/s^2]"]) * time**2 / 2
    where = "" if place == 0 else f", mesh from {place} m"
    return tools.Result(CASE, f"way, {name}, cells of {size} m{where}", "m", float(way(run, data)[-1]), "within", data["slack"][str(size)], float(exact), data["source"], run)


def start_disks(lab):
    """Starts the runs of two disks of this level, by size of cells."""
    return {size: lab.run(f"{CASE}/scene_disks.yaml", f"disks_{size}", {"mesh.size": size}) for size, level in DISKS.items() if lab.level in ("full", level)}


def start_disks_with_saflip(lab):
    """The same with the transfer `saflip`, which does not damp the vibration that the impact leaves."""
    return {size: lab.run(f"{CASE}/scene_disks.yaml", f"disks_{size}_saflip", {"mesh.size": size, "transfer.scheme": "saflip"})
            for size, level in DISKS.items() if lab.level in ("full", level)}


def judge_disks(size, run, data, note=""):
    """When the disks touch, the speed at which their centres part over that at which they met, and what is left of the energy."""
    history = run.history
    force = np.hypot(history["contact_left_right_x"], history["contact_left_right_y"])
    first = float(history["time"][np.argmax(force > 0.02 * force.max())])
    speed = history["momentum_left_x"] + history["momentum_left_y"]
    energy = history["kinetic"] + history["strain"]
    fine, name = size < 0.02 and not note, f"cells of {size} m{note}"
    criterion = ("near", data["early [s]"]) if fine else ("reported", None)
    rebound = ("within", data["restitution slack"]) if fine else ("reported", None)
    return [tools.Result(CASE, f"disks touch, {name}", "s", first, *criterion, data["contact [s]"], data["contact source"], run),
            tools.Result(CASE, f"restitution of the centres, {name}", "-", float(-speed[-1] / speed[0]), *rebound, data["restitution"], data["disk source"], run),
            tools.Result(CASE, f"energy of the disks at the end over that at the start, {name}", "-", float(energy[-1] / energy[0]), "reported", None, 1.0,
                         "conserved by the exact solution", run)]


def spheres_down(lab):
    """Starts spheres at full level, by size of cells."""
    return {size: lab.run(f"{CASE}/scene_sphere.yaml", f"sphere_{size}", {"mesh.size": size}) for size in SPHERES if lab.level == "full"}


def judge_sphere(size, run, data):
    """The way of a sphere at the end, and the mean friction over the mean pressure, each beside that of a rigid one."""
    history, (friction, degrees) = run.history, INCLINES[ROLLS]
    exact = acceleration(friction, degrees, data["gravity [m/s^2]"], 1.4) * history["time"][-1] ** 2 / 2
    speed, time = history["momentum_ball_x"] / history["mass_ball"], history["time"]  # of the centre of mass: no particle lies there
    came = np.sum((speed[1:] + speed[:-1]) / 2 * np.diff(time))
    used = abs(history["contact_plane_ball_x"].mean() / history["contact_plane_ball_z"].mean())
    return [tools.Result(CASE, f"way of a sphere, {ROLLS}, cells of {size} m", "m", float(came), "reported", None, float(exact), data["sphere source"], run),
            tools.Result(CASE, f"shear over pressure below a sphere that rolls, cells of {size} m", "-", float(used), "reported", None,
                         float(np.tan(np.radians(degrees)) * 0.4 / 1.4), data["sphere source"], run)]


def moduli_down(lab, data):
    """Starts disks of other stiffness at full level, by name and size of cells."""
    return {(name, size): run_down(lab, CASE, "contacts[0].friction", ROLLS, size, 0.0, data,
                                   {"materials[0].youngs_modulus": disk, "materials[1].youngs_modulus": plane}, f"_{name}")
            for name, (disk, plane) in MODULI.items() for size in (0.1, 0.05) if lab.level == "full"}


def judge_modulus(name, size, run, data):
    """The way of a disk of other stiffness."""
    exact = acceleration(*INCLINES[ROLLS], data["gravity [m/s^2]"]) * run.history["time"][-1] ** 2 / 2
    return tools.Result(CASE, f"way, {ROLLS}, {name}, cells of {size} m", "m", float(way(run, data)[-1]), "reported", None, float(exact), data["source"], run)


def of_kernel(lab, data):
    """Starts disks with another kernel, each with what measures it."""
    down = runs_down_of_kernel(lab, CASE, "contacts[0].friction", data)
    pairs = [(run, lambda key=key, run=run: [judge_incline(*key, run, data)]) for key, run in down.items()]
    return pairs + [(run, lambda size=size, run=run: judge_disks(size, run, data)) for size, run in start_disks(lab).items()]


def draw(figure, runs, way_of, data):
    """Ways over time: closed forms as lines, runs as marks."""
    axis = figure.subplots()
    for colour, name in enumerate(INCLINES):
        time = runs[name, 0.05, 0.0].history["time"]
        axis.plot(time, acceleration(*INCLINES[name], data["gravity [m/s^2]"]) * time**2 / 2, color=f"C{colour}", label=f"closed form, {name}")
        for mark, size in zip(("+", "o"), (0.1, 0.05)):
            run = runs[name, size, 0.0]
            axis.plot(run.history["time"][::10], way_of(run, data)[::10], mark, color=f"C{colour}", fillstyle="none",
                      label=f"talus, cells of {size} m" if colour == 0 else None)
    axis.set(xlabel="time [s]", ylabel="way of the middle of the disk [m]")
    axis.legend(fontsize=6)


def evaluate(lab):
    """Results of disks on planes and of colliding disks."""
    data = tools.reference(CASE)
    runs = runs_down(lab, CASE, "contacts[0].friction", data)
    disks, with_saflip = start_disks(lab), start_disks_with_saflip(lab)
    spheres, moduli = spheres_down(lab), moduli_down(lab, data)
    results = [judge_incline(name, size, place, run, data) for (name, size, place), run in runs.items()]
    for size, run in disks.items():
        results += judge_disks(size, run, data)
    for size, run in with_saflip.items():
        results += judge_disks(size, run, data, ", saflip")
    results += [result for size, run in spheres.items() for result in judge_sphere(size, run, data)]
    results += [judge_modulus(*key, run, data) for key, run in moduli.items()]
    results += tools.with_other_kernels(lab, lambda other: of_kernel(other, data))
    lab.figure(CASE, "verification_contact", lambda figure: draw(figure, runs, way, data), caption="Way of a disk down an inclined body.")
    return results
