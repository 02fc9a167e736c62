"""Rigid bodies: a sphere on an inclined wall, a disk that rolls or slides down an inclined body of particles, a strip and a circle pushed into clay, a boulder that hits a dam."""
import numpy as np

import lab as tools

CASE = "rigid_bodies"
CONTACT = tools.module("contact")  # the same inclines
# At full level: sizes of cells [m], and how much the room is higher than that of the scene [m], with which gmsh makes other triangles.
FOOTINGS = ((0.5, 0), (0.5, 0.1), (0.5, 0.23), (0.25, 0), (0.25, 0.1), (0.25, 0.23))
CIRCLES = (0.5,)  # m, at full level: sizes of cells
DAMS = {0.4: "quick", 0.2: "quick", 0.1: "full", 0.07: "full"}  # m, sizes of cells: 2.5, 5, 10 and 14 over the radius of the boulder
WALLS = (0, 0.1, 0.2, 0.28, 0.29, 1)


def on_wall(lab, friction):
    """Starts a run on a wall."""
    return lab.run(f"{CASE}/scene_wall.yaml", tools.label(f"wall_{friction}"), {"rigid[0].friction": friction})


def footing(lab, size, higher):
    """Starts a run of the strip."""
    return lab.run(f"{CASE}/scene_footing.yaml", f"footing_{size}_{higher}", {"mesh.size": size, "mesh.regions[0].shape.high": [20, 11.2 + higher]})


def circle(lab, size):
    """Starts a run of the circle."""
    return lab.run(f"{CASE}/scene_circle.yaml", f"circle_{size}", {"mesh.size": size})


def start_dams(lab):
    """Starts the dams of this level, by size of cells."""
    return {size: lab.run(f"{CASE}/scene_dam.yaml", f"dam_{size}", {"mesh.size": size}) for size, level in DAMS.items() if lab.level in ("full", level)}


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


def judge_footing(size, higher, run, data):
    """The mean load over the last tenth of the settlement, on half of the strip."""
    history, name = run.history, tools.mesh_name(size, higher)
    load = history["rigid_strip_fy"][-len(history["time"]) // 10:].mean() / (data["half width [m]"] * data["strength [Pa]"])
    wider = load * data["half width [m]"] / (data["half width [m]"] + size / 2)
    return [tools.Result(CASE, f"load of a strip over half width and strength, {name}", "-", float(load), "within", data["footing slack"], 2 + np.pi,
                         data["footing source"], run),
            tools.Result(CASE, f"the same, for a strip wider by half a cell on each side, {name}", "-", float(wider), "reported", None, 2 + np.pi,
                         data["footing source"], run)]


def judge_circle(size, run, data):
    """The mean load over the last fifth of the settlement, on a quarter of the circle."""
    history = run.history
    load = history["rigid_disk_fz"][-len(history["time"]) // 5:].mean() / (np.pi / 4 * data["radius of the circle [m]"]**2 * data["strength [Pa]"])
    return tools.Result(CASE, f"load of a circle over area and strength, 3-D, cells of {size} m", "-", float(load), "within", data["footing slack"],
                        data["circle"], data["circle source"], run)


def impulse(history, column):
    """Impulses of a mean force up to each row [N s]."""
    return np.concatenate([[0], np.cumsum(history[column][1:] * np.diff(history["time"]))])


def penetration(history, data):
    """How far the boulder is inside the face of the dam as it was at the start [m], over time."""
    foot, crest = (np.array(data[f"{end} of the face [m]"]) for end in ("foot", "crest"))
    along = (crest - foot) / np.linalg.norm(crest - foot)
    inward = np.array([along[1], -along[0]])
    return data["boulder radius [m]"] + (history["rigid_boulder_x"] - foot[0]) * inward[0] + (history["rigid_boulder_y"] - foot[1]) * inward[1]


def judge_dam(size, run, data):
    """Balances of momentum along x and of energy, and how far the boulder gets."""
    history, name = run.history, f"cells of {size} m"
    mass = np.pi * data["boulder radius [m]"]**2 * data["boulder density [kg/m^3]"]
    given = mass * history["rigid_boulder_vx"][0]
    boulder = mass * (history["rigid_boulder_vx"] - history["rigid_boulder_vx"][0])
    both = boulder + history["momentum_x"] - history["momentum_x"][0]
    off = np.abs(boulder - impulse(history, "rigid_boulder_fx")).max() / given
    walls = np.abs(both - impulse(history, "reaction_y_min_x")).max() / given
    power = -mass * data["dam gravity [m/s^2]"] * np.minimum(1, history["time"] / data["growth [s]"]) * history["rigid_boulder_vy"]
    fallen = np.sum((power[1:] + power[:-1]) / 2 * np.diff(history["time"]))
    kinetic = history["kinetic_rigid_boulder"]
    lost = kinetic[0] - kinetic[-1] + fallen
    inside = penetration(history, data)
    after = inside > 0
    results = [tools.Result(CASE, f"boulder, momentum less impulse of the material, over the momentum at the start, {name}", "-", float(off), "at most", data["momentum slack"], 0.0,
                            data["momentum source"], run),
               tools.Result(CASE, f"boulder and dam, momentum less impulse of the ground, over the momentum at the start, {name}", "-", float(walls), "at most",
                            data["momentum slack"], 0.0, data["momentum source"], run),
               tools.Result(CASE, f"work done on the dam over the energy that the boulder lost, {name}", "-", float((history["wall_work"][-1] - history["wall_work"][0]) / lost),
                            "within", data["energy slack"], 1.0, data["energy source"], run)]
    reported = {"penetration of the boulder": ("m", inside.max()), "boulder, time from touch to deepest penetration": ("s", history["time"][np.argmax(inside)] - history["time"][after][0]),
                "largest force on the boulder along x": ("N", -history["rigid_boulder_fx"].min()), "boulder, speed along x at the end": ("m/s", history["rigid_boulder_vx"][-1])}
    return results + [tools.Result(CASE, f"{what}, {name}", unit, float(value), "reported", None, None, "no closed form", run) for what, (unit, value) in reported.items()]


def draw_dam(figure, runs):
    """Velocity of the boulder along x over time."""
    axis = figure.subplots()
    for size, run in runs.items():
        axis.plot(run.history["time"], run.history["rigid_boulder_vx"], label=f"cells of {size} m")
    axis.set(xlabel="time [s]", ylabel="velocity of the boulder along x [m/s]")
    axis.legend()


def of_kernel(lab, data):
    """Starts disks, the strip and dams with another kernel, each with what measures it."""
    down = CONTACT.runs_down_of_kernel(lab, CASE, "rigid[0].friction", data)
    strip, dams = footing(lab, *FOOTINGS[0]), start_dams(lab)
    pairs = [(run, lambda key=key, run=run: judge_body(*key, run, data)) for key, run in down.items()]
    pairs += [(strip, lambda: judge_footing(*FOOTINGS[0], strip, data))]
    return pairs + [(run, lambda size=size, run=run: judge_dam(size, run, data)) for size, run in dams.items()]


def evaluate(lab):
    """Results of spheres on a wall, of disks on a body, of strips, of circles and of boulders."""
    data = tools.reference(CASE)
    walls = {friction: on_wall(lab, friction) for friction in WALLS}
    runs = CONTACT.runs_down(lab, CASE, "rigid[0].friction", data)
    footings = {at: footing(lab, *at) for at in FOOTINGS if lab.level == "full"}
    circles = {size: circle(lab, size) for size in CIRCLES if lab.level == "full"}
    dams = start_dams(lab)
    results = [judge_wall(friction, run, data) for friction, run in walls.items()]
    for at, run in footings.items():
        results += judge_footing(*at, run, data)
    results += [judge_circle(size, run, data) for size, run in circles.items()]
    for (name, size, place), run in runs.items():
        results += judge_body(name, size, place, run, data)
    for size, run in dams.items():
        results += judge_dam(size, run, data)
    results += tools.with_other_kernels(lab, lambda other: of_kernel(other, data))
    lab.figure(CASE, "verification_rigid_bodies_dam", lambda figure: draw_dam(figure, dams), caption="Velocity of a boulder that hits a dam.")
    lab.figure(CASE, "verification_rigid_bodies", lambda figure: CONTACT.draw(figure, runs, way, data), caption="Way of a rigid disk down an inclined body.")
    return results
