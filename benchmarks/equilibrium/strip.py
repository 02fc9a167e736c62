"""Half of a rigid rough strip on Mohr-Coulomb soil: bearing capacity factors N_q and N_gamma."""
import numpy as np

import lab as tools

SIZES = {"quick": (0.5,), "full": (0.5, 0.25, 0.125)}  # m, near the strip
INCREMENTS = {"surcharge": 12, "weight": 40}
LARGE = {"mesh.regions[0].shape.low": [0, -3], "mesh.regions[0].shape.high": [18, 6], "mesh.regions[2].shape.high": [18, 7],
         "bodies[0].shape.low": [0, -3], "bodies[0].shape.high": [18, 6]}
PLAIN = {"bodies[0].f_bar": False}
NO_DILATION = {"materials[0].dilation_angle": 0}


def friction(angle):
    """Changes to weight.yaml for another angle of friction [deg]."""
    return {"materials[0].friction_angle": angle, "materials[0].dilation_angle": angle,
            "stages[0].initial_stress.k0": round(1 - np.sin(np.radians(angle)), 3)}


def mesh(place):
    """Soil and mesh are so much wider [m]."""
    wide = 12 + place
    soil, air = [wide, 6], [wide, 7]
    return {"mesh.regions[0].shape.high": soil, "mesh.regions[2].shape.high": air, "bodies[0].shape.high": soil} if place else {}


def factors(angle):
    """N_c and N_q for an angle of friction [deg] (Prandtl, Reissner)."""
    tangent = np.tan(np.radians(angle))
    surcharge = np.exp(np.pi * tangent) * np.tan(np.radians(45 + angle / 2))**2
    return (surcharge - 1) / tangent, surcharge


def unit(scene, data):
    """By what the reaction [N] of half a strip is divided: q a, or gamma a^2."""
    wide = data["half width [m]"]
    return data["surcharge [Pa]"] * wide if scene == "surcharge" else data["weight [N/m^3]"] * wide**2


def expected(scene, data, angle):
    """The exact load. Cohesion adds c N_c, by superposition, which is on the safe side."""
    if scene == "surcharge":
        return factors(angle)[1]
    return data["N_gamma"][str(angle)] + data["cohesion [Pa]"] * factors(angle)[0] / (data["weight [N/m^3]"] * data["half width [m]"])


def loads(run, scene, data):
    """Settlement [m] and load of the stage in which the strip moves, with the surcharge below the strip."""
    push = run.history["stage"] == 1
    load = np.abs(run.history["reaction_strip_y"][push]) / unit(scene, data) + (scene == "surcharge")
    return data["settlement [m]"] * (run.history["time"][push] - 1), load


def capacity(run, scene, data):
    """The median of the load over the last quarter of the settlement, without the last increment."""
    way, load = (column[:-1] for column in loads(run, scene, data))
    return np.median(load[way > 0.75 * data["settlement [m]"]])


def slope(run, scene, data):
    """The slope of the load over the last quarter of the settlement, rising or falling, as a share of that of the first increment."""
    way, load = (column[:-1] for column in loads(run, scene, data))
    late = way > 0.75 * data["settlement [m]"]
    first = (load[0] - (scene == "surcharge")) / way[0]
    return abs(np.polyfit(way[late], load[late], 1)[0]) / first


def peak(run, scene, data):
    """The largest load without the last increment."""
    return np.max(loads(run, scene, data)[1][:-1])


def at_end(run, scene, data):
    """The load of the last increment over that of the one before."""
    load = loads(run, scene, data)[1]
    return load[-1] / load[-2]


def judge(scene, group, size, angle, kind):
    data = group.data
    judged = size < 0.5 and kind != "no dilation"
    exact = expected(scene, data, angle)

    def asked(criterion, limit):
        return (criterion, limit) if judged else ("reported", None)

    name = "load over q a" if scene == "surcharge" else "load over gamma a^2"
    wide = (1 + size / (2 * data["half width [m]"]))**(1 if scene == "surcharge" else 2)
    return [*group.result(name, "-", lambda run: capacity(run, scene, data), *asked("within", data["within"]), exact),
            *group.result(f"{name}, largest", "-", lambda run: peak(run, scene, data), reference=exact),
            *group.result(f"{name}, with the strip half a cell wider", "-", lambda run: capacity(run, scene, data) / wide, reference=exact),
            *group.result("slope over the last quarter over the first slope", "-", lambda run: slope(run, scene, data),
                          *asked("at most", data["largest slope"]), 0.0),
            *group.result("load of the last increment over that of the one before", "-", lambda run: at_end(run, scene, data),
                          *asked("within", data["largest slope"]), 1.0),
            *group.result("unbalanced force over the loads at the end", "-", lambda run: run.history["residual"][-1])]


def changes(size, increments, extra):
    return {"mesh.size": max(0.5, 2 * size), "mesh.refine[0].size": size, "stages[1].increments": increments, **extra}


def plan(level):
    """As plan_of() of the case, by size of cells, increments, angle of friction and what is different."""
    groups = {}

    def add(scene, size, increments, angle=30, kind="", extra=None):
        groups[scene, size, increments, angle, kind] = (
            lambda group, size, _, angle, kind: judge(scene, group, size, angle, kind), changes(size, increments, extra or {}))

    for size in SIZES[level]:
        add("surcharge", size, INCREMENTS["surcharge"])
    if level == "full":
        for size in SIZES[level]:
            add("weight", size, INCREMENTS["weight"])
        for scene, count in INCREMENTS.items():
            add(scene, 0.25, 2 * count)
            add(scene, 0.25, count, 30, "plain volumes", PLAIN)
            add(scene, 0.25, count, 30, "no dilation", NO_DILATION)
        add("surcharge", 0.25, 12, 30, "larger soil", LARGE)
        for angle in (20, 35):
            add("weight", 0.25, 40, angle, "", friction(angle))
    return groups
