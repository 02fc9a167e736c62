"""Rigid bodies: a sphere on an inclined wall, a disk that rolls or slides down an inclined body of particles, and a strip pushed into clay."""
import numpy as np

import lab as tools

CASE = "rigid_bodies"
INCLINES = {"rolls, friction 0.3, 30 degrees": (0.3, 30), "slides, friction 0.1, 30 degrees": (0.1, 30), "slides, friction 0.3, 60 degrees": (0.3, 60)}
SIZES = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # 5, 10 and 20 cells over the radius
PLACES = {0.0: "quick", -0.03: "full", -0.06: "full"}  # m, left end of the room: gmsh then makes other meshes
FOOTINGS = (0.5, 0.25)  # m, sizes of cells, at full level
WALLS = (0, 0.1, 0.2, 0.28, 0.29, 1)


def acceleration(friction, degrees, gravity, turning):
    """Down a plane [m/s^2]; `turning` is 1 plus the moment of inertia over mass and square of the radius."""
    angle = np.radians(degrees)
    if np.tan(angle) < friction * turning / (turning - 1):
        return gravity * np.sin(angle) / turning
    return gravity * (np.sin(angle) - friction * np.cos(angle))


def on_wall(lab, friction):
    """Starts a run on a wall."""
    return lab.run(f"{CASE}/scene_wall.yaml", tools.label(f"wall_{friction}"), {"rigid[0].friction": friction})


def judge_wall(friction, run, data):
    """The way of the sphere at the end."""
    history = run.history
    exact = acceleration(friction, 45, data["wall gravity [m/s^2]"], 1.4) * history["time"][-1] ** 2 / 2
    return tools.Result(CASE, f"way of a sphere on a wall, friction {friction}", "m", float(history["rigid_ball_x"][-1] - data["wall start [m]"]), "within",
                        data["wall slack"], float(exact), data["wall source"], run)


def on_body(lab, name, size, place, data):
    """Starts a run on a body of particles."""
    friction, degrees = INCLINES[name]
    angle, gravity = np.radians(degrees), data["gravity [m/s^2]"]
    settings = {"rigid[0].friction": friction, "loads[0].acceleration": [float(gravity * np.sin(angle)), float(-gravity * np.cos(angle))],
                "mesh.size": size, "mesh.regions[0].shape.low": [place, -0.5]}
    return lab.run(f"{CASE}/scene.yaml", tools.label(f"{name}_{size}_{-place}"), settings)


def judge_body(name, size, place, run, data):
    """The way of the disk at the end, and how much it turns for its way."""
    history = run.history
    friction, degrees = INCLINES[name]
    exact = acceleration(friction, degrees, data["gravity [m/s^2]"], 1.5) * history["time"][-1] ** 2 / 2
    where = "" if place == 0 else f", mesh from {place} m"
    results = [tools.Result(CASE, f"way of a disk on a body, {name}, cells of {size} m{where}", "m", float(history["rigid_disk_x"][-1] - data["start [m]"]),
                            "within", data["slack"][str(size)], float(exact), data["source"], run)]
    if name.startswith("rolls"):
        turned = -history["rigid_disk_wz"][-1] * data["radius [m]"] / history["rigid_disk_vx"][-1]
        results.append(tools.Result(CASE, f"rotation over that of rolling, cells of {size} m{where}", "-", float(turned), "within", data["slack"][str(size)], 1.0,
                                    data["source"], run))
    return results


def judge_footing(size, run, data):
    """The mean load over the last tenth of the settlement, on half of the strip."""
    history = run.history
    load = history["rigid_strip_fy"][-len(history["time"]) // 10:].mean() / (data["half width [m]"] * data["strength [Pa]"])
    wider = load * data["half width [m]"] / (data["half width [m]"] + size / 2)
    return [tools.Result(CASE, f"load of a strip over half width and strength, cells of {size} m", "-", float(load), "within", data["footing slack"], 2 + np.pi,
                         data["footing source"], run),
            tools.Result(CASE, f"the same, for a strip wider by half a cell on each side, cells of {size} m", "-", float(wider), "reported", None, 2 + np.pi,
                         data["footing source"], run)]


def draw(figure, runs, data):
    """Ways over time: closed forms as lines, runs as marks."""
    axis = figure.subplots()
    for colour, (name, (friction, degrees)) in enumerate(INCLINES.items()):
        time = runs[name, 0.05, 0.0].history["time"]
        axis.plot(time, acceleration(friction, degrees, data["gravity [m/s^2]"], 1.5) * time**2 / 2, color=f"C{colour}", label=f"closed form, {name}")
        for mark, size in zip(("+", "o"), (0.1, 0.05)):
            history = runs[name, size, 0.0].history
            axis.plot(history["time"][::10], history["rigid_disk_x"][::10] - data["start [m]"], mark, color=f"C{colour}", fillstyle="none",
                      label=f"talus, cells of {size} m" if colour == 0 else None)
    axis.set(xlabel="time [s]", ylabel="way of the middle of the disk [m]")
    axis.legend(fontsize=6)


def evaluate(lab):
    """Results of spheres on a wall and of disks on a body."""
    data = tools.reference(CASE)
    walls = {friction: on_wall(lab, friction) for friction in WALLS}
    runs = {(name, size, place): on_body(lab, name, size, place, data) for name in INCLINES for size in SIZES for place in PLACES
            if lab.level == "full" or {SIZES[size], PLACES[place]} == {"quick"}}
    footings = {size: lab.run(f"{CASE}/scene_footing.yaml", f"footing_{size}", {"mesh.size": size}) for size in FOOTINGS if lab.level == "full"}
    results = [judge_wall(friction, run, data) for friction, run in walls.items()]
    for size, run in footings.items():
        results += judge_footing(size, run, data)
    for (name, size, place), run in runs.items():
        results += judge_body(name, size, place, run, data)
    lab.figure(CASE, "verification_rigid_bodies", lambda figure: draw(figure, runs, data), caption="Way of a rigid disk down an inclined body.")
    return results
