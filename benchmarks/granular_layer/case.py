"""Dry grains of the law mu(I) down a rough incline, beside the steady profile of Bagnold."""
import numpy as np

import lab as tools

CASE = "granular_layer"
SIZES = {0.25: "quick", 0.125: "quick", 0.0625: "full"}  # m: 4, 8 and 16 cells over the depth
PLACES = {0.0: "quick", -0.03: "full", -0.06: "full"}  # m, left end of the room: gmsh then makes other meshes
EVERY = 0.25  # s between frames
fluids = tools.module("fluid_layer")


def surface(data):
    """Speed of the surface [m/s] in steady flow."""
    own, angle = data["material"], np.radians(data["angle [deg]"])
    mobilised = (np.tan(angle) - own["static_friction"]) / (own["limiting_friction"] - np.tan(angle))
    return float(2 / 3 * own["inertial_number"] * mobilised / own["grain_diameter"]
                 * np.sqrt(own["density"] / own["grain_density"] * data["gravity [m/s^2]"] * np.cos(angle)) * data["depth [m]"] ** 1.5)


def bagnold(y, data):
    """Steady velocity [m/s]."""
    return surface(data) * (1 - np.clip(1 - y / data["depth [m]"], 0, None) ** 1.5)


def middle(run, time, data):
    """Fields of the particles in the middle of the layer, away from its ends."""
    frame = run.frames[round(time / EVERY)]
    x, limits = frame["position"][:, 0], data["middle [m]"]
    inside = (x > limits[0]) & (x < limits[1])
    return {name: frame[name][inside] for name in ("position", "velocity", "stress", "volume", "velocity_gradient")}


def error(run, time, data):
    """Root mean square error of the velocity along the plane over that of the surface."""
    seen = middle(run, time, data)
    return tools.rms(seen["velocity"][:, 0] - bagnold(seen["position"][:, 1], data)) / surface(data)


def judge(size, place, run, data):
    """Velocity at all times (judged at the last), and the friction that is mobilised in the middle half of the depth."""
    where, results = fluids.named(size, place), []
    for time in data["times [s]"]:
        asked = ("at most", data["slack"]) if time == data["times [s]"][-1] else ("reported", None)
        results.append(tools.Result(CASE, f"velocity, rms over that of the surface at {time} s, {where}", "-", error(run, time, data), *asked, 0.0, data["source"], run))
    seen = middle(run, time, data)
    y, weight = seen["position"][:, 1], seen["volume"]
    inner = (y > 0.25) & (y < 0.75)
    near = (y > 0.9) & (y < 1)
    return results + [
        tools.Result(CASE, f"shear over normal stress at {time} s, {where}", "-",
                     float(weight[inner] @ seen["stress"][inner, 3] / -(weight[inner] @ seen["stress"][inner, 1])), "reported", None,
                     float(np.tan(np.radians(data["angle [deg]"]))), data["friction source"], run),
        tools.Result(CASE, f"stress along the plane over that normal to it at {time} s, {where}", "-",
                     float((weight[inner] @ seen["stress"][inner, 0]) / (weight[inner] @ seen["stress"][inner, 1])), "reported", None, 1.0, data["along source"], run),
        tools.Result(CASE, f"mean velocity between y = 0.9 and 1 m at {time} s, {where}", "m/s", float(np.mean(seen["velocity"][near, 0])), "reported", None,
                     float(np.mean(bagnold(y[near], data))), data["source"], run)]


def draw(figure, runs, data):
    """Velocity and shear rate over the height."""
    left, right = figure.subplots(1, 2, sharey=True)
    y, height, time = np.linspace(0, data["depth [m]"], 200), data["depth [m]"], data["times [s]"][-1]
    left.plot(bagnold(y, data), y, "k", label="Bagnold")
    right.plot(np.gradient(bagnold(y, data), y), y, "k")
    for colour, (size, run) in enumerate(runs.items()):
        seen = middle(run, time, data)
        left.plot(seen["velocity"][:, 0], seen["position"][:, 1], ".", ms=2, color=f"C{colour}", label=f"cells of {size:g} m")
        right.plot(*fluids.profile(seen, seen["velocity_gradient"][:, 1], height)[::-1], "o-", ms=3, lw=0.6, color=f"C{colour}")
    left.set(xlabel=f"velocity [m/s] at {time:g} s", ylabel="height [m]")
    right.set(xlabel="shear rate [1/s]")
    left.legend(fontsize=7)


def evaluate(lab):
    """Results on all meshes of this level."""
    data = tools.reference(CASE)
    runs = tools.ends({(size, place): lab.run(f"{CASE}/scene.yaml", tools.label(f"{size}_{-place}"), {"mesh.size": size, "mesh.regions[0].shape.low": [place, 0]})
                       for size in SIZES for place in PLACES if lab.level == "full" or {SIZES[size], PLACES[place]} == {"quick"}})
    sizes = sorted((size for size, place in runs if place == 0), reverse=True)
    lab.figure(CASE, "verification_bagnold", lambda figure: draw(figure, {size: runs[size, 0.0] for size in sizes}, data), size=(7.6, 3.4),
               caption="Grains down a rough incline: velocity and shear rate over the height beside Bagnold's profile.")
    return [result for (size, place), run in runs.items() for result in judge(size, place, run, data)]
