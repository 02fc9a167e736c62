"""Stages without inertia beside closed forms: column, Cook's membrane, footings, elastica, thick cylinder, hole in soil."""
import numpy as np

import fields
import lab as tools

CASE = "equilibrium"
PLACES = {"quick": (0,), "full": (0, 0.13, 0.31)}  # m: so much is the mesh wider, and gmsh makes other triangles
COLUMN = {"quick": (2.5, 1.25), "full": (2.5, 1.25, 0.625)}  # m, cells
MEMBRANE = {"quick": (("0.3", 4, 2), ("0.3", 4, 20), ("0.3", 2, 2), ("0.499", 4, 2), ("0.499", 2, 2)),  # Poisson's ratio, cells [m], increments
            "full": (("0.3", 4, 20), *((nu, size, 2) for nu in ("0.3", "0.499", "0.49999") for size in (4, 2, 1)))}
FOOTING = {"quick": ((1, 50), (0.5, 50)),  # cells [m], increments
           "full": ((1, 25), (1, 50), (1, 100), (0.5, 25), (0.5, 50), (0.5, 100), (0.25, 50))}
CANTILEVER = {"quick": (("2", 0.5),), "full": tuple((load, size) for load in ("1", "2", "9.6") for size in (0.5, 0.35, 0.25))}  # load, m
ELASTIC = {"quick": (0.25, 0.125), "full": (0.25, 0.125, 0.0625)}  # m
CYLINDER = {"quick": (0.25,), "full": (0.25, 0.125, 0.0625)}  # m
HIGH = {"column": (5, 57), "membrane": (54, 70), "cantilever": (11, 2), "cylinder": (2.5, 2.5)}  # m, upper corner of the mesh


class Group:
    """Runs of one scene at one size of cells, one for each place of the body in the mesh, and their results."""

    def __init__(self, lab, scene, name, settings):
        self.scene, self.name, self.data = scene, name, tools.reference(CASE)[scene]
        self.runs = {place: lab.run(f"{CASE}/{scene}.yaml", tools.label(f"{scene}, {name}, {place} m wider"),
                                    {**settings, **mesh_of(scene, place)}) for place in PLACES[lab.level]}

    @property
    def ended(self):
        return tools.ends(self.runs)

    def result(self, metric, unit, measure, criterion="reported", tolerance=None, reference=None, source=None):
        """One result for each run that came to its end."""
        return [tools.Result(CASE, f"{self.scene}: {metric}, {self.name}{f', mesh {place} m wider' if place else ''}", unit,
                             float(measure(run)), criterion, tolerance, reference(run) if callable(reference) else reference,
                             source or self.data["source"], run) for place, run in self.ended.items()]


def mesh_of(scene, place):
    """Changes to a scene that make its mesh wider."""
    if scene == "footing":  # both regions
        return {"mesh.regions[0].shape.high": [20 + place, 10], "mesh.regions[2].shape.high": [20 + place, 11]} if place else {}
    if scene in ("surcharge", "weight", "hole"):
        return tools.module(CASE, "hole" if scene == "hole" else "strip").mesh(place)
    wide, high = HIGH[scene]
    if scene == "column":  # between smooth sides, which are those of the mesh
        return {"mesh.regions[0].shape.high": [wide + place, high], "bodies[0].shape.high": [wide + place, 50]} if place else {}
    return {"mesh.regions[0].shape.high": [wide + place, high + place]} if place else {}


def left_over(run):
    """The unbalanced force over the loads at the end of the first stage."""
    return run.history["residual"][run.history["stage"] == 0][-1]


def start_of(frame):
    """Where the particles were at the beginning."""
    return (frame["position"] - frame["displacement"])[:, :2]


def balance(group):
    """The results that all scenes have: what is left out of balance, and the time."""
    data = tools.reference(CASE)["column"]
    asked = ("at most", data["largest unbalanced force"]) if group.scene == "column" else ("reported", None)
    return [*group.result("unbalanced force over the loads at the end of the first stage", "-", left_over, *asked, 0.0,
                          data["rest source"]),
            *group.result("processor time", "s", lambda run: run.seconds, source="clock of the machine")]


def settlement(height, data):
    """Settlement [m] of what was at `height`: the integral of 1 - F from the base."""
    y = np.linspace(0, height, 2001)
    ratio = data["weight [N/m^3]"] * (data["height [m]"] - y) / data["modulus [Pa]"]
    return float(np.trapz(1 + ratio - np.sqrt(ratio**2 + 1), y))


def stress_error(run, data):
    """Mean over the mass of the error in vertical stress, over the stress at the base, at the end of the static stage."""
    frame, weight = run.frames[1], data["weight [N/m^3]"]
    exact = -weight * (data["height [m]"] - start_of(frame)[:, 1])
    return np.average(np.abs(frame["stress"][:, 1] - exact), weights=frame["mass"]) / (weight * data["height [m]"])


def top(run):
    """Height before loading of the highest particle, and its settlement at the end of the static stage [m]."""
    frame = run.frames[1]
    high = int(np.argmax(start_of(frame)[:, 1]))
    return start_of(frame)[high, 1], -frame["displacement"][high, 1]


def kinetic(run):
    """The largest kinetic energy of the stage with inertia over the work of the weight."""
    return np.max(run.history["kinetic"][run.history["stage"] == 1]) / run.history["gravity_work"][-1]


def judge_column(group):
    data = group.data
    return [*group.result("stress error", "-", lambda run: stress_error(run, data), "at most", data["largest stress error"], 0.0),
            *group.result("settlement of the top", "m", lambda run: top(run)[1], "within", data["settlement within"],
                          lambda run: settlement(top(run)[0], data)),
            *group.result("largest kinetic energy in the stage that follows over the work done", "-", kinetic, "at most",
                          data["largest kinetic energy over the work done"], 0.0, data["rest source"])]


def lift(run, corner):
    """Upward displacement of a corner: no particle sits there, so a linear field fitted to the twelve nearest ones is extended."""
    frame = run.last_frame()
    return fields.extended(start_of(frame), frame["displacement"][:, 1], np.array(corner, dtype=float))


def judge_membrane(group, nu, size, _):
    data = group.data
    asked = ("within", data["within"][nu]) if size <= 2 else ("reported", None)
    return [*group.result("lift of the corner", "m", lambda run: lift(run, data["corner"]), *asked, data["lift [m]"][nu]),
            *group.result("scatter of pressure within cells over that of cells", "-", lambda run: fields.checkerboard(run.last_frame())),
            *(group.result("time of the run", "s", lambda run: run.seconds, "at most", data["longest time [s]"], None, "our own limit")
              if nu == "0.49999" else [])]


def loads_of(run, data):
    """Settlement [m] and load over a c of the strip."""
    unit = data["half width [m]"] * data["strength [Pa]"]
    return data["settlement [m]"] * run.history["time"], np.abs(run.history["reaction_strip_y"]) / unit


def slope(run, data):
    """The slope of the load over the last quarter of the settlement, as a share of the first slope."""
    way, load = (column[:-1] for column in loads_of(run, data))  # the last increment: see at_end()
    late, rising = way > 0.75 * way[-1], (load > 0.1 * load[-1]) & (load < load[-1] / 2)
    return np.polyfit(way[late], load[late], 1)[0] / np.polyfit(way[rising], load[rising], 1)[0]


def capacity(run, data):
    """The median of the load over a c in the last tenth of the settlement."""
    way, load = loads_of(run, data)
    return np.median(load[way > 0.9 * way[-1]])


def at_end(run, data):
    """The load of the last increment over that of the one before."""
    load = loads_of(run, data)[1]
    return load[-1] / load[-2]


def judge_footing(group, size, _):
    data, asked = group.data, size <= 0.5
    load = ("within", data["within"]) if asked else ("reported", None)
    return [*group.result("load over a c", "-", lambda run: capacity(run, data), *load, data["bearing capacity over strength"]),
            *group.result("load over a c in the last row, where all is in balance", "-", lambda run: loads_of(run, data)[1][-1], *load,
                          data["bearing capacity over strength"]),
            *group.result("slope over the last quarter over the first slope", "-", lambda run: slope(run, data),
                          *(("at most", data["largest slope"]) if asked else ("reported", None)), 0.0),
            *group.result("load of the last increment over that of the one before", "-", lambda run: at_end(run, data), "within",
                          data["within"], 1.0, "the load is on a plateau")]


def judge_cantilever(group, load, size):
    elastica = tools.module("elastica")
    beam = tools.reference("elastica")
    asked = ("within", group.data["within"]) if size <= elastica.JUDGED else ("reported", None)
    drop, shortening = elastica.theory(load, beam)
    return [*group.result("drop of the tip over the length", "-", lambda run: elastica.tip(run, beam)[0], *asked, drop),
            *group.result("shortening over the length", "-", lambda run: elastica.tip(run, beam)[1], reference=shortening)]


class Hill:
    """Stress and displacement of a thick cylinder that yields to the radius c, Tresca's criterion, small strains (Hill 1950)."""

    def __init__(self, data):
        self.inner, self.outer, self.plastic = (data[f"{name} radius [m]"] for name in ("inner", "outer", "plastic"))
        self.strength, self.modulus, self.ratio = data["strength [Pa]"], data["youngs_modulus [Pa]"], data["poisson_ratio"]

    def stress(self, r):
        """Radial and hoop stress [Pa]."""
        share = self.strength * self.plastic**2 / self.outer**2
        elastic = share * (1 - self.outer**2 / r**2), share * (1 + self.outer**2 / r**2)
        radial = self.strength * (2 * np.log(np.minimum(r, self.plastic) / self.plastic) - 1 + self.plastic**2 / self.outer**2)
        return np.where(r < self.plastic, radial, elastic[0]), np.where(r < self.plastic, radial + 2 * self.strength, elastic[1])

    def outward(self, r):
        """Displacement [m] in the elastic part."""
        share = self.strength * self.plastic**2 / self.outer**2
        return (1 + self.ratio) / self.modulus * share * ((1 - 2 * self.ratio) * r + self.outer**2 / r)


def ring(run, frame=-1):
    """Radius at the start, radial and hoop stress, outward displacement, and plastic strain of the particles, and their mass."""
    frame = run.frames[frame]
    place = start_of(frame)
    radius = np.linalg.norm(place, axis=1)
    x, y = (place / radius[:, None]).T
    xx, yy, xy = (frame["stress"][:, component] for component in (0, 1, 3))
    radial, hoop = xx * x * x + yy * y * y + 2 * xy * x * y, xx * y * y + yy * x * x - 2 * xy * x * y
    return radius, radial, hoop, frame["displacement"][:, 0] * x + frame["displacement"][:, 1] * y, frame["plastic_strain"], frame["mass"]


def ring_error(run, exact):
    """Root mean square over the mass of the error of radial and hoop stress, over the strength."""
    radius, radial, hoop, _, _, mass = ring(run)
    wrong = (radial - exact.stress(radius)[0])**2 + (hoop - exact.stress(radius)[1])**2
    return np.sqrt(np.average(wrong, weights=mass)) / exact.strength


def yielded(run, exact):
    """Radius [m] up to which the mass of the particles with plastic strain would reach."""
    _, _, _, _, strain, mass = ring(run)
    share = mass[strain > 1e-9].sum() / mass.sum()
    return np.sqrt(exact.inner**2 + share * (exact.outer**2 - exact.inner**2))


def grown(run, exact):
    """Mean over the elastic particles of the outward displacement over the exact one."""
    radius, _, _, outward, _, mass = ring(run)
    far = radius > 1.05 * exact.plastic
    return np.average(outward[far] / exact.outward(radius[far]), weights=mass[far])


def judge_cylinder(group, size):
    data, exact = group.data, Hill(group.data)
    asked = size <= 0.125

    def judged(criterion, key):
        return (criterion, data[key]) if asked else ("reported", None)

    return [*group.result("error of radial and hoop stress over the strength, rms", "-", lambda run: ring_error(run, exact),
                          *judged("at most", "largest stress error"), 0.0),
            *group.result("outward displacement of the elastic part over the exact one", "-", lambda run: grown(run, exact),
                          *judged("within", "displacement within"), 1.0),
            *group.result("plastic radius", "m", lambda run: yielded(run, exact), *judged("within", "plastic radius within"),
                          exact.plastic)]


class Lame(Hill):
    """The same cylinder, elastic under a pressure at its inner side [Pa]."""

    def __init__(self, data, pressure):
        super().__init__(data)
        self.share = pressure * self.inner**2 / (self.outer**2 - self.inner**2)

    def stress(self, r):
        return self.share * (1 - self.outer**2 / r**2), self.share * (1 + self.outer**2 / r**2)

    def outward(self, r):
        return (1 + self.ratio) / self.modulus * self.share * ((1 - 2 * self.ratio) * r + self.outer**2 / r)


def elastic_errors(run, data, frame):
    """Root mean square of the error of stress over the pressure, and the outward displacement over the exact one, in a frame of the run."""
    pressure = data["pressure [Pa]"] * run.frames[frame].time
    exact = Lame(data, pressure)
    radius, radial, hoop, outward, _, mass = ring(run, frame)
    wrong = (radial - exact.stress(radius)[0])**2 + (hoop - exact.stress(radius)[1])**2
    return np.sqrt(np.average(wrong, weights=mass)) / pressure, np.average(outward / exact.outward(radius), weights=mass)


def judge_elastic(group, size):
    data, source = group.data, group.data["elastic source"]
    judged = size <= 0.125
    results = []
    for frame, when in ((1, "under half of the pressure"), (2, "under the whole pressure, at the end of the stage")):
        asked = [(criterion, data[key]) if judged else ("reported", None) for criterion, key in
                 (("at most", "largest elastic stress error"), ("within", "displacement within"))]
        results += [*group.result(f"error of radial and hoop stress over the pressure, rms, {when}", "-",
                                  lambda run, frame=frame: elastic_errors(run, data, frame)[0], *asked[0], 0.0, source),
                    *group.result(f"outward displacement over the exact one, {when}", "-",
                                  lambda run, frame=frame: elastic_errors(run, data, frame)[1], *asked[1], 1.0, source)]
    return results


def draw(figure, groups):
    """Column, footing and cylinder: stress over height, load over settlement, stress over radius."""
    left, middle, right = figure.subplots(1, 3)
    for (scene, *rest), group in groups.items():
        for place, run in group.ended.items():
            if place or "elastic" in rest:
                continue
            if scene == "footing":
                middle.plot(*(column[:-1] for column in loads_of(run, group.data)), label=group.name)
            if scene == "column":
                frame = run.frames[1]
                left.plot(frame["stress"][:, 1] / 1e3, start_of(frame)[:, 1], ".", markersize=2, label=group.name)
            if scene == "cylinder":
                radius, radial, hoop, *_ = ring(run)
                right.plot(radius, radial / 1e3, ".", markersize=2, color="C0")
                right.plot(radius, hoop / 1e3, ".", markersize=2, color="C1")
    data = tools.reference(CASE)
    base = data["column"]["weight [N/m^3]"] * data["column"]["height [m]"] / 1e3
    left.plot([-base, 0], [0, data["column"]["height [m]"]], "k-", linewidth=0.8, label="exact")
    middle.axhline(data["footing"]["bearing capacity over strength"], color="k", linewidth=0.8, label="Prandtl")
    exact, radii = Hill(data["cylinder"]), np.linspace(1, 2, 101)
    for curve, name in zip(exact.stress(radii), ("radial", "hoop")):
        right.plot(radii, curve / 1e3, "k-", linewidth=0.8)
        right.annotate(name, (radii[-1], curve[-1] / 1e3), ha="right", va="bottom")
    left.set(xlabel="vertical stress [kPa]", ylabel="height before loading [m]", title="column")
    middle.set(xlabel="settlement [m]", ylabel="load / (a c)", title="strip footing")
    right.set(xlabel="radius [m]", ylabel="stress [kPa]", title="cylinder")
    left.legend(fontsize=7)
    middle.legend(fontsize=7)


def plan_of(level):
    """By scene and parameters: how a group is judged, and its changes to the scene."""
    elastica, beam = tools.module("elastica"), tools.reference("elastica")
    plan = {("column", size): (judge_column, {"mesh.size": size}) for size in COLUMN[level]}
    plan |= {("footing", size, count): (judge_footing, {"mesh.size": size, "stages[0].increments": count})
             for size, count in FOOTING[level]}
    plan |= {("cylinder", size, "elastic"): (judge_elastic, {"mesh.size": size, "materials[0].cohesion": 1e9, "stages[0].increments": 2,
                                                             "outputs.particles.every": 0.5}) for size in ELASTIC[level]}
    plan |= {("cylinder", size): (judge_cylinder, {"mesh.size": size}) for size in CYLINDER[level]}
    plan |= {("membrane", nu, size, count): (judge_membrane, {"materials[0].poisson_ratio": float(nu), "mesh.size": size,
                                                              "stages[0].increments": count,
                                                              **({"stages[0].residual": 1e-4} if nu == "0.49999" else {})})
             for nu, size, count in MEMBRANE[level]}
    plan |= {("cantilever", load, size): (judge_cantilever, {
        "mesh.size": size, "loads[0].traction": [0, -round(elastica.force(load, beam), 6)]}) for load, size in CANTILEVER[level]}
    return plan | tools.module(CASE, "strip").plan(level) | tools.module(CASE, "hole").plan(level)


def evaluate(lab):
    """All scenes at the sizes of the level; of those whose run fails the failure is the result."""
    plan = plan_of(lab.level)
    words = {"membrane": "nu {}, cells of {} m, {} increments", "cantilever": "load {}, cells of {} m",
             "footing": "cells of {} m, {} increments", "hole": "cells of {} m, {}, {}",
             **dict.fromkeys(("surcharge", "weight"), "cells of {} m, {} increments, phi {}, {}")}
    plain = {2: "cells of {} m", 3: "cells of {} m, {}"}
    groups = {key: Group(lab, key[0], words.get(key[0], plain.get(len(key))).format(*key[1:]).removesuffix(", "), settings)
              for key, (_, settings) in plan.items()}
    results = []
    for key, group in groups.items():
        judge = plan[key][0]
        results += judge(group) if key[0] == "column" else judge(group, key[1]) if key[0] == "cylinder" else judge(group, *key[1:])
        results += balance(group)
    for scene, measure in (("column", stress_error), ("cylinder", ring_error)):
        data = tools.reference(CASE)[scene]
        exact = data if scene == "column" else Hill(data)
        of = {key[1]: group.ended for key, group in groups.items() if key[0] == scene and len(key) == 2 and group.ended}
        if len(of) > 1:
            lab.convergence(CASE, f"stress error of the {scene}", list(of),
                            [tools.rms([measure(run, exact) for run in runs.values()]) for runs in of.values()], expected=1)
    lab.figure(CASE, "verification_equilibrium", lambda figure: draw(figure, groups), size=(10.0, 3.4),
               caption="States of equilibrium found without inertia: column, strip footing, cylinder that yields to 1.5 m (lines: exact).")
    return results
