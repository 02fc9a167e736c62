"""Rigid bodies: a sphere on an inclined wall, a disk that rolls or slides down an inclined body of particles, and a strip pushed into clay."""
import numpy as np

import lab as tools

CASE = "rigid_bodies"
CONTACT = tools.module("contact")  # the same inclines
FOOTINGS = (0.5, 0.25)  # m, sizes of cells, at full level
WALLS = (0, 0.1, 0.2, 0.28, 0.29, 1)


def on_wall(lab, friction):
    """Starts a run on a wall."""
    return lab.run(f"{CASE}/scene_wall.yaml", tools.label(f"wall_{friction}"), {"rigid[0].friction": friction})


def judge_wall(friction, run, data):
    """The way of the sphere at the end."""
    history = run.history
    exact = CONTACT.acceleration(friction, 45, data["wall gravity [m/s^2]"], 1.4) * history["time"][-1] ** 2 / 2
    return tools.Result(CASE, f"way of a sphere on a wall, friction {friction}", "m", float(history["rigid_ball_x"][-1] - data["wall start [m]"]), "within",
                        data["wall slack"], float(exact), data["wall source"], run)


def way(run, data):
    """How far the middle of the disk has come [m]."""
    return run.history["rigid_disk_x"] - data["start [m]"]


def judge_body(name, size, place, run, data):
    """The way of the disk at the end, and how much it turns for its way."""
    history = run.history
    friction, degrees = CONTACT.INCLINES[name]
    exact = CONTACT.acceleration(friction, degrees, data["gravity [m/s^2]"]) * history["time"][-1] ** 2 / 2
    where = "" if place == 0 else f", mesh from {place} m"
    results = [tools.Result(CASE, f"way of a disk on a body, {name}, cells of {size} m{where}", "m", float(way(run, data)[-1]),
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


def evaluate(lab):
    """Results of spheres on a wall and of disks on a body."""
    data = tools.reference(CASE)
    walls = {friction: on_wall(lab, friction) for friction in WALLS}
    runs = CONTACT.runs_down(lab, CASE, "rigid[0].friction", data)
    footings = {size: lab.run(f"{CASE}/scene_footing.yaml", f"footing_{size}", {"mesh.size": size}) for size in FOOTINGS if lab.level == "full"}
    results = [judge_wall(friction, run, data) for friction, run in walls.items()]
    for size, run in footings.items():
        results += judge_footing(size, run, data)
    for (name, size, place), run in runs.items():
        results += judge_body(name, size, place, run, data)
    lab.figure(CASE, "verification_rigid_bodies", lambda figure: CONTACT.draw(figure, runs, way, data), caption="Way of a rigid disk down an inclined body.")
    return results
