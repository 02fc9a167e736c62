"""Bodies with velocity fields of their own against closed forms: a block on a body, two beams tied and loose, two spheres that collide."""
import numpy as np

import lab as tools

CASE = "contact_bodies"
SLOPES = {"slides, tan a = 0.577": 0.57735, "slides, tan a = 0.35": 0.35, "sticks, tan a = 0.25": 0.25}  # friction 0.3
BLOCKS = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # m: 4, 8 and 16 cells over the height
BEAMS = {0.1: "quick", 0.05: "quick", 0.025: "full"}  # m: 2, 4 and 8 cells over the height of one
SPHERES = {0.24: "quick", 0.12: "quick", 0.06: "full"}  # m at the contact: 1.3, 2.5 and 5 cells over the radius of the contact
FRICTION = 0.3
HERTZ = tools.module("hertz_contact")


def at_level(lab, sizes):
    """The sizes of cells of this level."""
    return [size for size, level in sizes.items() if lab.level == "full" or level == "quick"]


def block(lab, slope, size, data):
    """Starts a run of a block on a plane with that tangent of its angle."""
    angle, gravity = np.arctan(slope), data["gravity [m/s^2]"]
    settings = {"loads[0].acceleration": [float(gravity * np.sin(angle)), float(-gravity * np.cos(angle))], "mesh.size": size}
    return lab.run(f"{CASE}/scene.yaml", tools.label(f"block_{slope}_{size}"), settings)


def way(slope, time, data, friction):
    """How far a rigid block slides [m] under a gravity that grows linearly at first."""
    angle, ramp = np.arctan(slope), data["ramp [s]"]
    falls = (time - ramp)**2 / 2 + (time - ramp) * ramp / 2 + ramp**2 / 6
    return data["gravity [m/s^2]"] * max(0.0, np.sin(angle) - friction * np.cos(angle)) * falls


def judge_block(name, size, run, data):
    """The way at the end beside that of a rigid block, or beside that without friction where it should stick."""
    slope, time = SLOPES[name], run.history["time"][-1]
    slid = float(run.history["middle_x"][-1] - data["start [m]"])
    if slope < FRICTION:
        return tools.Result(CASE, f"way over that without friction, {name}, cells of {size} m", "-", abs(slid) / way(slope, time, data, 0), "at most", data["creep"], 0.0,
                            data["creep source"], run)
    return tools.Result(CASE, f"way, {name}, cells of {size} m", "m", slid, "within", data["slack"], float(way(slope, time, data, FRICTION)), data["block source"], run)


def deflection(run):
    """Largest deflection of the tips in their first swing [m], mean of both beams."""
    return float(-np.min((run.history["low_tip_uy"] + run.history["high_tip_uy"]) / 2))


def judge_beams(size, tied, loose, data):
    """How much less tied beams bend."""
    slender = 1.5 * (data["length [m]"] / data["height [m]"])**2
    exact = (slender + 1.2) / (slender / 4 + 1.2)
    return tools.Result(CASE, f"deflection of loose beams over that of tied ones, cells of {size} m", "-", deflection(loose) / deflection(tied), "within", data["slack"], exact,
                        data["beam source"], loose)


def force(run):
    """Force between the whole spheres [N], four times that of the quarters."""
    return 4 * np.abs(run.history["contact_low_high_z"])


def judge_spheres(size, run, data, judged):
    """Largest force and duration of the contact over Hertz's, speed of parting over that of meeting, energy left."""
    history, mass = run.history, 4 * run.history["mass_high"][0]
    _, largest, duration = HERTZ.hertz(data, mass)
    touching = history["time"][force(run) > HERTZ.TOUCH * largest]
    asked = ("within", data["sphere slack"]) if judged else ("reported", None)
    parting = float(4 * history["momentum_high_z"][-1] / mass / data["speed [m/s]"])
    energy = float((history["kinetic"][-1] + history["strain"][-1]) / history["kinetic"][0])
    return [tools.Result(CASE, f"largest force over Hertz's, cells of {size} m", "-", float(force(run).max() / largest), *asked, 1.0, data["sphere source"], run),
            tools.Result(CASE, f"duration of the contact over Hertz's, cells of {size} m", "-", float((touching[-1] - touching[0]) / duration), *asked, 1.0,
                         data["sphere source"], run),
            tools.Result(CASE, f"spheres touch, cells of {size} m", "s", float(touching[0]), "reported", None, data["gap [m]"] / data["speed [m/s]"], "gap over speed", run),
            tools.Result(CASE, f"speed of parting over that of meeting, cells of {size} m", "-", parting, "reported", None, 1.0, "Hertz: no energy is lost to waves", run),
            tools.Result(CASE, f"energy at the end over that at the start, cells of {size} m", "-", energy, "reported", None, 1.0, "conserved by the exact solution", run)]


def draw_spheres(figure, runs, data):
    """Force over time; Hertz begins where the spheres touch."""
    axis = figure.subplots()
    _, largest, duration = HERTZ.hertz(data, 4 / 3 * np.pi * data["density [kg/m^3]"] * data["radius [m]"]**3)
    time = np.linspace(0, duration, 200)
    axis.plot(time + data["gap [m]"] / data["speed [m/s]"], largest * HERTZ.force_history(time, duration), "k", label="Hertz")
    for size, run in runs.items():
        axis.plot(run.history["time"], force(run), label=f"talus, cells of {size} m")
    axis.set(xlabel="time [s]", ylabel="force between the spheres [N]")
    axis.legend()


def start_blocks(lab, data):
    """Starts the blocks of this level, by name of the slope and size of cells."""
    return {(name, size): block(lab, slope, size, data) for name, slope in SLOPES.items() for size in at_level(lab, BLOCKS)}


def start_beams(lab):
    """Starts tied and loose beams of this level, by size of cells."""
    return {size: [lab.run(f"{CASE}/scene_beams.yaml", f"{name}_{size}", {"mesh.size": size, **tie}) for name, tie in (("tied", {"contacts[0].tied": True}), ("loose", {}))]
            for size in at_level(lab, BEAMS)}


def start_spheres(lab):
    """Starts the spheres of this level, by size of cells."""
    return {size: lab.run(f"{CASE}/scene_spheres.yaml", f"spheres_{size}", {"mesh.refine[0].size": size, "mesh.refine[1].size": min(0.3, 2 * size)})
            for size in at_level(lab, SPHERES)}


def of_kernel(lab, data):
    """Starts blocks, beams and spheres with another kernel, each with what measures it."""
    blocks, beams, spheres = start_blocks(lab, data), start_beams(lab), start_spheres(lab)
    pairs = [(run, lambda name=name, size=size, run=run: [judge_block(name, size, run, data)]) for (name, size), run in blocks.items()]
    pairs += [(loose if tied.ending[0] == 0 else tied, lambda size=size, tied=tied, loose=loose: [judge_beams(size, tied, loose, data)])
              for size, (tied, loose) in beams.items()]
    return pairs + [(run, lambda size=size, run=run: judge_spheres(size, run, data, False)) for size, run in spheres.items()]


def evaluate(lab):
    """Results of blocks, beams and spheres."""
    data = tools.reference(CASE)
    blocks, beams, spheres = start_blocks(lab, data), start_beams(lab), start_spheres(lab)
    results = [judge_block(name, size, run, data) for (name, size), run in blocks.items()]
    results += [judge_beams(size, *pair, data) for size, pair in beams.items()]
    for size, run in spheres.items():
        results += judge_spheres(size, run, data, lab.level == "full" and size == min(SPHERES))
    results += tools.with_other_kernels(lab, lambda other: of_kernel(other, data))
    lab.figure(CASE, "verification_contact_spheres", lambda figure: draw_spheres(figure, spheres, data), caption="Force between two spheres that collide.")
    return results
