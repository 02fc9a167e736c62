"""Flow along walls beside closed forms: plane Couette and Poiseuille flow, and layers of fluids with and without yield stress down an incline."""
import numpy as np

import lab as tools

CASE = "fluid_layer"
SIZES = {0.25: "quick", 0.125: "quick", 0.0625: "full"}  # m: 4, 8 and 16 cells over the height of 1 m
YIELDING = {0.25: "quick", 0.125: "full", 0.0833333: "full"}  # m: 4, 8 and 12 cells; the viscosity of the plug makes steps short
COSTLY = 0.0833333  # m
PLACES = {0.0: "quick", -0.03: "full", -0.06: "full"}  # m, left end of the room: gmsh then makes other meshes
TERMS = np.arange(1, 200)
BINS = 16  # over the height, for means of shear and stress


def couette(y, time, data):
    """Velocity [m/s] between a wall at rest and one that moves from the time 0 on."""
    own = data["couette"]
    nu, decay = own["viscosity [Pa s]"] / data["density [kg/m^3]"], np.pi * TERMS / data["depth [m]"]
    series = (2 * (-1.0) ** TERMS / (np.pi * TERMS) * np.sin(np.outer(y, decay))) @ np.exp(-nu * decay**2 * time)
    return own["speed [m/s]"] * (y / data["depth [m]"] + series)


def poiseuille(y, time, data):
    """Velocity [m/s] between two walls at rest, driven from the time 0 on."""
    own, height = data["poiseuille"], data["depth [m]"]
    nu, push = own["viscosity [Pa s]"] / data["density [kg/m^3]"], own["acceleration [m/s^2]"]
    odd = TERMS[::2]
    decay = np.pi * odd / height
    series = (4 * push / (nu * height * decay**3) * np.sin(np.outer(y, decay))) @ np.exp(-nu * decay**2 * time)
    return push / (2 * nu) * y * (height - y) - series


def along(data):
    """Gravity along the incline [m/s^2]."""
    return data["layer"]["gravity [m/s^2]"] * np.sin(np.radians(data["layer"]["angle [deg]"]))


def layer(y, time, data):
    """Velocity [m/s] of a Newtonian layer with a free surface that is released at the time 0."""
    nu, height, push = data["layer"]["viscosity [Pa s]"] / data["density [kg/m^3]"], data["depth [m]"], along(data)
    decay = np.pi * (TERMS - 0.5) / height
    series = (2 * push / (nu * height * decay**3) * np.sin(np.outer(y, decay))) @ np.exp(-nu * decay**2 * time)
    return push / (2 * nu) * (2 * height * y - y**2) - series


def ideal(y, fluid, data):
    """Steady velocity [m/s] of the fluid without regularisation."""
    pull, n = data["density [kg/m^3]"] * along(data), fluid["flow_index"]
    flowing = max(data["depth [m]"] - fluid["yield_stress"] / pull, 0.0)
    power = 1 + 1 / n
    return (pull / fluid["consistency"]) ** (1 / n) / power * (flowing**power - np.clip(flowing - y, 0, None) ** power)


def regularised(y, fluid, data):
    """Steady velocity [m/s] of the law as it is: the shear rate by bisection on the stress, integrated from the wall."""
    height = data["depth [m]"]
    places = np.linspace(0, height, 4001)
    stress, m, n = data["density [kg/m^3]"] * along(data) * (height - places), fluid["regularisation"], fluid["flow_index"]
    low, high = np.zeros_like(places), np.full_like(places, 1e3)
    for _ in range(100):
        rate = (low + high) / 2
        held = rate if n == 1 else np.maximum(rate, 1 / m)
        above = fluid["consistency"] * rate * held ** (n - 1) + fluid["yield_stress"] * -np.expm1(-m * rate) > stress
        low, high = np.where(above, low, rate), np.where(above, rate, high)
    speed = np.concatenate([[0], np.cumsum((low[1:] + low[:-1]) / 2 * np.diff(places))])
    return np.interp(y, places, speed)


def middle(run, time, limits):
    """Fields of the particles in the middle of the body, away from its ends; frames are 0.05 s apart."""
    frame = run.frames[round(time / 0.05)]
    x = frame["position"][:, 0]
    inside = (x > limits[0]) & (x < limits[1])
    return {name: frame[name][inside] for name in ("position", "velocity", "stress", "volume", "velocity_gradient")}


def error(run, time, limits, closed):
    """Root mean square error of the velocity along the wall over the largest velocity of the closed form; closed(y)."""
    seen = middle(run, time, limits)
    exact = closed(seen["position"][:, 1])
    return tools.rms(seen["velocity"][:, 0] - exact) / float(closed(np.linspace(0, 1, 201)).max())


def profile(seen, values, height):
    """Middles of bins over the height [m] and means in them, weighted by volume."""
    edges = np.linspace(0, height, BINS + 1)
    total, _ = np.histogram(seen["position"][:, 1], edges, weights=seen["volume"])
    sums, _ = np.histogram(seen["position"][:, 1], edges, weights=seen["volume"] * values)
    kept = total > 0
    return ((edges[1:] + edges[:-1]) / 2)[kept], sums[kept] / total[kept]


def height_where(y, values, level):
    """The largest height [m] below which a profile that falls with the height is above a level."""
    last = int(np.nonzero(values > level)[0][-1])
    return float(np.interp(level, [values[last + 1], values[last]], [y[last + 1], y[last]])) if last + 1 < len(y) else float(y[-1])


def named(size, place):
    """The mesh, in the names of results."""
    return f"cells of {round(size, 4):g} m" + ("" if place == 0 else f", mesh from {place} m")


def wanted(lab, sizes, once=()):
    """The meshes of this level, (size, place); sizes of `once` at the first place only."""
    return [(size, place) for size in sizes for place in PLACES if {sizes[size], PLACES[place]} == {"quick"} or lab.level == "full" and (place == 0 or size not in once)]


def judge_newtonian(flow, title, closed, runs, data):
    """Error of the profile at each time; judged with 16 cells over the height."""
    own, results = data[flow], []
    for (size, place), run in runs.items():
        for time in own["times [s]"]:
            asked = ("at most", data["slack"]) if size < 0.07 else ("reported", None)
            results.append(tools.Result(CASE, f"{title}: velocity, rms over the largest at {time} s, {named(size, place)}", "-",
                                        error(run, time, own["middle [m]"], lambda y, time=time: closed(y, time, data)), *asked, 0.0, own["source"], run))
    return results


def converge(lab, flow, title, closed, runs, data):
    """Notes the order of convergence at the last time, on the first place of the mesh."""
    own = data[flow]
    time = own["times [s]"][-1]
    sizes = sorted((size for size, place in runs if place == 0), reverse=True)
    if len(sizes) > 1:
        errors = [error(runs[size, 0.0], time, own["middle [m]"], lambda y: closed(y, time, data)) for size in sizes]
        lab.convergence(CASE, f"{title}: velocity at {time} s", sizes, errors, 2.0)


def judge_yielding(name, runs, data):
    """Profile beside the law as regularised (judged with 12 cells) and beside the ideal fluid; thickness of the plug by stress and by shear."""
    own, results = data["yielding"], []
    fluid, time, limits, height = own["fluids"][name], own["time [s]"], own["middle [m]"], data["depth [m]"]
    plug = fluid["yield_stress"] / (data["density [kg/m^3]"] * along(data))
    fine = np.linspace(0, height, 2001)
    tenth = float(np.gradient(ideal(fine, fluid, data), fine)[0] / 10)
    slow = height - height_where(fine, np.gradient(regularised(fine, fluid, data), fine), tenth)
    for (size, place), run in runs.items():
        seen, where = middle(run, time, limits), named(size, place)
        asked = ("at most", own["slack"]) if size < 0.1 else ("reported", None)
        within = ("within", own["slack"]) if size < 0.1 else ("reported", None)
        results += [
            tools.Result(CASE, f"{name}: velocity, rms over the largest, {where}", "-", error(run, time, limits, lambda y: regularised(y, fluid, data)), *asked, 0.0,
                         own["regularised source"], run),
            tools.Result(CASE, f"{name}: velocity beside the ideal fluid, {where}", "-", error(run, time, limits, lambda y: ideal(y, fluid, data)), "reported", None, 0.0,
                         own["source"], run),
            tools.Result(CASE, f"{name}: thickness of the plug by stress, {where}", "m",
                         height - height_where(*profile(seen, seen["stress"][:, 3], height), fluid["yield_stress"]), *within, plug, own["plug source"], run),
            tools.Result(CASE, f"{name}: thickness that shears by less than a tenth of the rate at the wall, {where}", "m",
                         height - height_where(*profile(seen, seen["velocity_gradient"][:, 1], height), tenth), "reported", None, slow, own["regularised source"], run)]
    return results


def judge_creep(runs, data):
    """Velocity of the surface of a layer below yield."""
    fluid, own, height = data["below yield"]["fluid"], data["below yield"], data["depth [m]"]
    results = []
    for (size, place), run in runs.items():
        seen = middle(run, data["yielding"]["time [s]"], data["yielding"]["middle [m]"])
        y, speed = profile(seen, seen["velocity"][:, 0], height)
        creep = float(speed[-1])
        asked = ("within", data["yielding"]["slack"]) if size < 0.1 else ("reported", None)
        results.append(tools.Result(CASE, f"below yield: creep at y = {y[-1]:.3g} m, {named(size, place)}", "m/s", creep, *asked,
                                    float(regularised(y[-1:], fluid, data)[0]), own["source"], run))
    return results


def draw(figure, newtonian, yielding, data):
    """Profiles of velocity: closed forms as lines, particles as marks."""
    left, right = figure.subplots(1, 2, sharey=True)
    y = np.linspace(0, data["depth [m]"], 200)
    for colour, (flow, (closed, run)) in enumerate(newtonian.items()):
        for time in data[flow]["times [s]"]:
            left.plot(closed(y, time, data), y, color=f"C{colour}", label=f"closed form, {flow}" if time == data[flow]["times [s]"][0] else None)
            seen = middle(run, time, data[flow]["middle [m]"])
            left.plot(seen["velocity"][::3, 0], seen["position"][::3, 1], ".", ms=2, color=f"C{colour}")
    left.set(xlabel=f"velocity [m/s] at {' and '.join(f'{t:g}' for t in data['couette']['times [s]'])} s", ylabel="height [m]")
    own = data["yielding"]
    for colour, (name, run) in enumerate(yielding.items()):
        fluid = own["fluids"].get(name, data["below yield"]["fluid"])
        right.plot(ideal(y, fluid, data), y, color=f"C{colour}", ls="--", lw=0.8)
        right.plot(regularised(y, fluid, data), y, color=f"C{colour}", label=f"law, {name}")
        seen = middle(run, own["time [s]"], own["middle [m]"])
        right.plot(seen["velocity"][::3, 0], seen["position"][::3, 1], ".", ms=2, color=f"C{colour}")
    right.set(xlabel="velocity [m/s]; dashed: without regularisation")
    for axis in (left, right):
        axis.legend(fontsize=7)


def evaluate(lab):
    """Results of all flows."""
    data = tools.reference(CASE)
    changes = {"couette": {}, "poiseuille": {"boundaries[1].velocity": [0, 0], "loads": f"[{{type: gravity, acceleration: [{data['poiseuille']['acceleration [m/s^2]']}, 0]}}]"},
               "layer": {}}
    titles = {"couette": "Couette", "poiseuille": "Poiseuille", "layer": "layer"}
    closed = {"couette": couette, "poiseuille": poiseuille, "layer": layer}
    newtonian = {flow: {(size, place): lab.run(f"{CASE}/{'layer' if flow == 'layer' else 'channel'}.yaml", tools.label(f"{flow}_{size}_{-place}"),
                                               {**change, "mesh.size": size, "mesh.regions[0].shape.low": [place, 0]})
                        for size, place in wanted(lab, SIZES if flow == "layer" else {**SIZES, 0.0625: "quick"})} for flow, change in changes.items()}
    fluids = {**data["yielding"]["fluids"], "below yield": data["below yield"]["fluid"]}
    yielding = {name: {(size, place): lab.run(f"{CASE}/layer.yaml", tools.label(f"{name}_{size}_{-place}"),
                                              {"mesh.size": size, "mesh.regions[0].shape.low": [place, 0],
                                               "materials[0]": {"name": "fluid", "law": "herschel_bulkley", "density": data["density [kg/m^3]"], "bulk_modulus": 2e6, **fluid}})
                       for size, place in wanted(lab, YIELDING, [COSTLY])} for name, fluid in fluids.items()}
    newtonian, yielding = ({name: tools.ends(runs) for name, runs in group.items()} for group in (newtonian, yielding))
    results = []
    for flow, runs in newtonian.items():
        results += judge_newtonian(flow, titles[flow], closed[flow], runs, data)
        converge(lab, flow, titles[flow], closed[flow], runs, data)
    for name in data["yielding"]["fluids"]:
        results += judge_yielding(name, yielding[name], data)
    results += judge_creep(yielding["below yield"], data)
    lab.figure(CASE, "verification_fluid_layer", lambda figure: draw(figure, {flow: (closed[flow], runs[min(runs)[0], 0.0]) for flow, runs in newtonian.items()},
                                                                     {name: runs[min(runs)[0], 0.0] for name, runs in yielding.items()}, data),
               size=(7.6, 3.6), caption="Velocity over the height: Couette, Poiseuille and a layer down an incline at two times; layers with a yield stress.")
    return results
