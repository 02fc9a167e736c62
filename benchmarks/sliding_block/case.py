"""A block on an inclined face of the mesh: distance slid with Coulomb friction, the plane inclined or gravity, and rest where friction holds it."""
import numpy as np

import lab as tools

CASE = "sliding_block"
COEFFICIENTS = [0, 0.3, 0.5]
METHODS = {"flip": tools.METHODS["umls, flip"], "tpic": tools.METHODS["umls, tpic"], "projected, aflip": tools.METHODS["projected, aflip"]}


def slid(history, angle):
    """Distance of the centre of mass from its start, down a slope of `angle` [rad]."""
    dx, dy = history["centre_x"] - history["centre_x"][0], history["centre_y"] - history["centre_y"][0]
    return dx * np.cos(angle) - dy * np.sin(angle)


def closed_form(time, data, friction):
    """Distance slid by a rigid block."""
    angle = np.radians(data["angle [deg]"])
    return data["gravity [m/s^2]"] * (np.sin(angle) - friction * np.cos(angle)) * time**2 / 2


def apart(run, turned, angle):
    """Largest difference of the distances slid down the inclined plane and along the horizontal one under inclined gravity, over the distance at the end."""
    inclined, flat = slid(run.history, angle), slid(turned.history, 0)
    return float(np.max(np.abs(np.interp(run.history["time"], turned.history["time"], flat) - inclined)) / inclined[-1])


def creep(run):
    """Largest distance of the centre of mass from its place at the end of the geostatic stage [m]."""
    after = run.history["stage"] == 1
    x, y = run.history["centre_x"][after], run.history["centre_y"][after]
    return float(np.max(np.hypot(x - x[0], y - y[0])))


def draw(figure, runs, data):
    """Distance over time, closed forms as lines, runs as marks."""
    axis = figure.subplots()
    angle = np.radians(data["angle [deg]"])
    for colour, friction in enumerate(COEFFICIENTS):
        time = runs["flip", friction].history["time"]
        axis.plot(time, closed_form(time, data, friction), color=f"C{colour}", label=f"closed form, friction {friction}")
        for mark, method in zip(("o", "+", "x"), METHODS):
            axis.plot(time[::10], slid(runs[method, friction].history, angle)[::10], mark, color=f"C{colour}", fillstyle="none",
                      label=f"talus, {method}" if colour == 0 else None)
    axis.set(xlabel="time [s]", ylabel="distance slid [m]")
    axis.legend()


def judge_turned(friction, run, turned, data):
    """Results of a block under inclined gravity beside the one on the inclined plane."""
    angle = np.radians(data["angle [deg]"])
    return [
        tools.Result(CASE, f"distance slid, friction {friction}, flip, gravity inclined", "m", float(slid(turned.history, 0)[-1]), "within", data["slack"],
                     float(closed_form(turned.history["time"][-1], data, friction)), data["source"], turned),
        tools.Result(CASE, f"inclined plane and inclined gravity apart, friction {friction}", "-", apart(run, turned, angle), "at most", data["slack"], 0.0,
                     data["turned source"], turned)]


def evaluate(lab):
    """Results for three coefficients with three methods, the same with gravity turned, and the creep of a block that must not move."""
    data, angle, results = tools.reference(CASE), np.radians(tools.reference(CASE)["angle [deg]"]), []
    runs = {(method, friction): lab.run(f"{CASE}/scene.yaml", f"{tools.label(method)}_{friction}", {"boundaries[0].coefficient": friction, **METHODS[method]})
            for method in METHODS for friction in COEFFICIENTS}
    turned = {friction: lab.run(f"{CASE}/scene_turned.yaml", f"turned_{friction}", {"boundaries[0].coefficient": friction}) for friction in COEFFICIENTS}
    rests = {name: lab.run(f"{CASE}/scene_rest.yaml", tools.label(f"rest{name}"), METHODS[method])
             for name, method in (("", "flip"), (", projected, aflip", "projected, aflip"))}
    for (method, friction), run in runs.items():
        results.append(tools.Result(CASE, f"distance slid, friction {friction}, {method}", "m", float(slid(run.history, angle)[-1]), "within", data["slack"],
                                    float(closed_form(run.history["time"][-1], data, friction)), data["source"], run))
    for friction in COEFFICIENTS:
        results += judge_turned(friction, runs["flip", friction], turned[friction], data)
    results += [tools.Result(CASE, f"creep in 1 s at 25 degrees, friction 0.5{name}", "m", creep(rest), "at most", data["rest"]["largest creep [m]"],
                             0.0, data["rest"]["source"], rest) for name, rest in tools.ends(rests).items()]
    lab.figure(CASE, "verification_block", lambda figure: draw(figure, runs, data), caption="Distance slid down a face inclined by 45 degrees.")
    return results
