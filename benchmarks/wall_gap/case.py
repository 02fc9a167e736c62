"""A disk that rolls or slides down an inclined wall of the mesh, which acts where the disk touches it, or at its nodes."""
import numpy as np

import lab as tools

CASE = "wall_gap"
CONTACT = tools.module("contact")  # the same inclines
INCLINES = CONTACT.INCLINES | {"rolls, friction 0.5, 30 degrees": (0.5, 30)}
WITHOUT_GAP = "rolls, friction 0.3, 30 degrees"


def down_wall(lab, name, size, place, gap, data):
    """Starts a run."""
    friction, degrees = INCLINES[name]
    angle, gravity = np.radians(degrees), data["gravity [m/s^2]"]
    settings = {"boundaries[0].coefficient": friction, "boundaries[0].gap": gap, "mesh.size": size, "mesh.regions[0].shape.low": [place, 0],
                "loads[0].acceleration": [float(gravity * np.sin(angle)), float(-gravity * np.cos(angle))]}
    return lab.run(f"{CASE}/scene.yaml", tools.label(f"{name}_{size}_{-place}_{gap}"), settings)


def spin(run, data):
    """Angular velocity at the end, down the incline [rad/s]: angular momentum about the centre of mass over the moment of inertia of a disk."""
    history = run.history
    about_centre = (history["angular_momentum_z"] - history["centre_x"] * history["momentum_y"] + history["centre_y"] * history["momentum_x"])[-1]
    return -float(about_centre / (0.5 * history["mass"][-1] * data["radius [m]"]**2))


def rigid_spin(name, time, data):
    """The same of a rigid disk."""
    friction, degrees = INCLINES[name]
    angle, gravity = np.radians(degrees), data["gravity [m/s^2]"]
    if np.tan(angle) < 3 * friction:
        return gravity * np.sin(angle) / 1.5 * time / data["radius [m]"]
    return 2 * friction * gravity * np.cos(angle) * time / data["radius [m]"]


def judge(name, size, place, gap, run, data):
    """Way and spin at the end beside those of a rigid disk."""
    time = run.history["time"][-1]
    where = f"{name}, cells of {size} m" + ("" if place == 0 else f", mesh from {place} m") + ("" if gap else ", at nodes")
    asked = ("within", data["slack"][str(size)]) if gap else ("reported", None)
    exact = CONTACT.acceleration(*INCLINES[name], data["gravity [m/s^2]"]) * time**2 / 2
    return [tools.Result(CASE, f"way, {where}", "m", float(CONTACT.way(run, data)[-1]), *asked, float(exact), data["source"], run),
            tools.Result(CASE, f"spin, {where}", "rad/s", spin(run, data), *asked, float(rigid_spin(name, time, data)), data["spin source"], run)]


def draw(figure, runs, data):
    """Ways over time of one incline: the closed form, and both kinds of wall."""
    axis = figure.subplots()
    time = runs[WITHOUT_GAP, 0.05, 0.0, True].history["time"]
    axis.plot(time, CONTACT.acceleration(*INCLINES[WITHOUT_GAP], data["gravity [m/s^2]"]) * time**2 / 2, "k", label="closed form")
    for colour, size in enumerate((0.1, 0.05)):
        for line, gap, name in (("-", True, "where it touches"), ("--", False, "at nodes")):
            run = runs[WITHOUT_GAP, size, 0.0, gap]
            axis.plot(run.history["time"], CONTACT.way(run, data), line, color=f"C{colour}", label=f"wall acts {name}, cells of {size} m")
    axis.set(xlabel="time [s]", ylabel="way of the middle of the disk [m]")
    axis.legend(fontsize=7)


def evaluate(lab):
    """Results of disks on an inclined wall."""
    data = tools.reference(CASE)
    levels = [(size, place) for size in CONTACT.SIZES for place in CONTACT.PLACES
              if lab.level == "full" or {CONTACT.SIZES[size], CONTACT.PLACES[place]} == {"quick"}]
    asked = [(name, size, place, True) for name in INCLINES for size, place in levels] + [(WITHOUT_GAP, size, place, False) for size, place in levels]
    runs = {which: down_wall(lab, *which, data) for which in asked}
    results = [result for which, run in runs.items() for result in judge(*which, run, data)]
    lab.figure(CASE, "verification_wall_gap", lambda figure: draw(figure, runs, data), caption="Way of a disk that rolls down an inclined wall of the mesh.")
    return results
