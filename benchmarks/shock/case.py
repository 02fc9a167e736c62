"""Shocks: speed, compression and stress behind them against the jump conditions, ringing with and without artificial viscosity."""
import numpy as np

import lab as tools

CASE = "shock"
CELLS = {"quick": 204, "full": 612}
VISCOUS = {"materials[0].bulk_viscosity.linear": 0.5, "materials[0].bulk_viscosity.quadratic": 2}
CUSTOMARY = {"materials[0].bulk_viscosity.linear": 0.06, "materials[0].bulk_viscosity.quadratic": 1.5}
INVISCID = {"materials[0].bulk_viscosity.linear": 0, "materials[0].bulk_viscosity.quadratic": 0}


def profile(run):
    """Initial place X [m], velocity [m/s], longitudinal stress [Pa] and stretch of the last frame, in order of X."""
    frame = run.last_frame()
    start = frame["position"][:, 0] - frame["displacement"][:, 0]
    order = np.argsort(start)
    return start[order], frame["velocity"][order, 0], frame["stress"][order, 0], frame["F"][order, 0]


def front(place, velocity, speed):
    """Where the velocity passes half of that of the material ahead."""
    behind = velocity > -speed / 2
    return float(place[behind].max())


def plateau(place, values, position):
    """The values behind the front, clear of the wall and of the front itself."""
    return values[(place > 0.25 * position) & (place < 0.75 * position)]


def overshoot(velocity, speed):
    """How far the velocity behind the front goes beyond that of the wall, over the jump: the mean of 1 % of the particles."""
    return float(np.mean(np.sort(velocity)[-max(1, len(velocity) // 100):]) / speed)


def shock(run, speed):
    """Speed of the shock, stretch and stress behind it, overshoot."""
    place, velocity, stress, stretch = profile(run)
    position = front(place, velocity, speed)
    time = run.history["time"][-1]
    return position / time, float(np.mean(plateau(place, stretch, position))), -float(np.mean(plateau(place, stress, position))), overshoot(velocity, speed)


def elastic_limit(run):
    """Mean compression [Pa] of the middle half of what lies between the two waves: where stress is between 5 and 60 % of its largest."""
    place, _, stress, _ = profile(run)
    between = place[(-stress > 0.05 * -stress.min()) & (-stress < 0.6 * -stress.min())]
    low, high = between.min(), between.max()
    middle = (place > low + (high - low) / 4) & (place < high - (high - low) / 4)
    return -float(np.mean(stress[middle]))


def draw(figure, runs):
    """Velocity and stress over initial place, with and without viscosity."""
    left, right = figure.subplots(1, 2)
    for name, run in runs.items():
        place, velocity, stress, _ = profile(run)
        left.plot(place, velocity, lw=0.8, label=name)
        right.plot(place, -stress, lw=0.8, label=name)
    left.set(xlabel="initial place [m]", ylabel="velocity [m/s]")
    right.set(xlabel="initial place [m]", ylabel="compression [Pa]")
    left.legend()


def evaluate(lab):
    """Three elastic laws at two speeds, copper at two, the elastic limit of steel."""
    data, results = tools.reference(CASE), []
    cells = CELLS[lab.level]
    grid = {"mesh.grid.cells": [cells, 4], "mesh.grid.high": [1.02, 0.02 * 204 / cells]}
    box = {"bodies[0].shape.high": [1, 0.02 * 204 / cells]}
    pictured = {}

    def add(metric, unit, value, criterion, tolerance, wanted, source, run):
        results.append(tools.Result(CASE, metric, unit, value, criterion, tolerance, wanted, source, run))

    elastic = data["elastic"]
    for law in ("neo_hookean", "hencky", "linear_elastic"):
        for i, speed in enumerate(elastic["speed"]):
            run = lab.run(f"{CASE}/scene.yaml", f"{law}_{speed}", {**grid, **box, **VISCOUS, "materials[0].law": law, "bodies[0].velocity": [-speed, 0]})
            celerity, stretch, stress, peak = shock(run, speed)
            what = f"{law}, piston at {speed} c_L"
            add(f"speed of the shock, {what}", "m/s", celerity, "within", 0.01, elastic[law]["U"][i], elastic["source"], run)
            add(f"stretch behind it, {what}", "-", stretch, "within", 0.01, elastic[law]["F"][i], elastic["source"], run)
            add(f"stress behind it, {what}", "Pa", stress, "within", 0.01, elastic[law]["U"][i] * speed, elastic["source"], run)
            add(f"overshoot, {what}", "-", peak, "at most", 0.02, 0.0, "monotone profile of the exact solution", run)
            if law == "neo_hookean" and speed == 0.2:
                pictured["with bulk viscosity 0.5, 2"] = run
                plain = lab.run(f"{CASE}/scene.yaml", "inviscid", {**grid, **box, **INVISCID, "materials[0].law": law, "bodies[0].velocity": [-speed, 0]})
                pictured["without"] = plain
                customary = lab.run(f"{CASE}/scene.yaml", "customary", {**grid, **box, **CUSTOMARY, "materials[0].law": law, "bodies[0].velocity": [-speed, 0]})
                pictured["with 0.06, 1.5"] = customary
                add("overshoot with the viscosity customary for finite elements", "-", shock(customary, speed)[3], "reported", None, 0.0,
                    "monotone profile of the exact solution", customary)
                add("speed of the shock without viscosity", "m/s", shock(plain, speed)[0], "within", 0.01, elastic[law]["U"][i], elastic["source"], plain)
                add("overshoot without viscosity", "-", shock(plain, speed)[3], "reported", None, 0.0, "monotone profile of the exact solution", plain)

    copper = data["copper"]
    for i, speed in enumerate(copper["speed [m/s]"]):
        run = lab.run(f"{CASE}/scene_metal.yaml", f"copper_{speed}", {"bodies[0].velocity": [-speed, 0]})
        _, stretch, stress, _ = shock(run, speed)
        add(f"pressure behind the shock, copper at {2 * speed} m/s", "Pa", stress, "within", 0.01, copper["pressure [Pa]"][i], copper["source"], run)
        add(f"compression behind the shock, copper at {2 * speed} m/s", "-", 1 / stretch, "within", 0.01, copper["compression"][i], copper["source"], run)
    steel = data["steel"]
    run = lab.run(f"{CASE}/scene_steel.yaml", "steel", {})
    add("stress between elastic and plastic wave, steel", "Pa", elastic_limit(run), "within", 0.01, steel["limit [Pa]"], steel["source"], run)
    lab.figure(CASE, "verification_shock", lambda figure: draw(figure, pictured), size=(7.4, 3.6), caption="Velocity and stress behind a shock in a neo-Hookean bar, piston at 0.2 c_L.")
    return results
