"""Extremes: what is expected of each is stated before it is run: bounded, or refused with words that name the reason; never NaN, never silent."""
import numpy as np

import lab as tools
import meshes

CASE = "extremes"
FLAT, SOLID, HEAP, LAYERS, PAIR = (f"{CASE}/{name}.yaml" for name in ("scene", "scene_3d", "scene_heap", "scene_layers", "scene_pair"))
KERNELS = {"umls": {"kernel": "umls"}, "linear": {"kernel": "linear"}, "projected": tools.METHODS["projected, aflip"]}  # the first two with the transfer of the scene
BESIDE = ("plain, 3-D", "cells with angles of 0.1 degrees", "cells in turn wide and narrow by 10", "cells smaller by 10 beyond the middle", "1 particles per cell",
          "stiffness by 1e+06, density by 1000 across a face", "CFL 1", "torn apart, cells empty")  # flights with projected as well
RUBBER = {"name": "rubber", "law": "neo_hookean", "density": 1000, "youngs_modulus": 1.0e5, "poisson_ratio": 0.3}


# Measures: histories of bodies that nothing touches.


def inner(history):
    """Kinetic energy at the start without that of the mean motion [J]: what there is to deform and spin the body."""
    momentum = np.array([values[0] for name, values in history.items() if name.startswith("momentum_")])
    return history["kinetic"][0] - momentum @ momentum / (2 * history["mass"][0])


def gained(run):
    """Largest kinetic and strain energy in the last third less that in the first third, over what there was to deform the body [-]: a sum that
    swings by a share of the step over the period, as it does where velocities and places take turns, is no gain."""
    history = run.history
    energy, end = history["kinetic"] + history["strain"], history["time"][-1]
    return float((np.max(energy[history["time"] > 2 / 3 * end]) - np.max(energy[history["time"] < end / 3])) / inner(history))


def gained_in_all(run):
    """Largest gain of kinetic and strain energy over the kinetic energy at the start [-]."""
    energy = run.history["kinetic"] + run.history["strain"]
    return float(np.max(energy - energy[0]) / energy[0])


def momentum_drift(run):
    """Largest change of momentum over mass times a mean speed, the root of the mean square [-]."""
    history = run.history
    scale = np.sqrt(2 * history["mass"][0] * history["kinetic"][0])
    return float(max(np.max(np.abs(values - values[0])) for name, values in history.items() if name.startswith("momentum_")) / scale)


def mass_drift(run):
    """Change of mass, what was removed included, over mass [-]."""
    mass = run.summary["balances"]["mass"]
    return abs(mass["end [kg]"] + mass["removed [kg]"] - mass["start [kg]"]) / mass["start [kg]"]


def strayed(run):
    """Of a body in uniform motion: the larger of the drift of momentum and the share of energy that is not that of the motion [-]."""
    history = run.history
    drift = np.abs(history["kinetic"] + history["strain"] - history["kinetic"][0]) + np.abs(history["strain"])
    return float(max(momentum_drift(run), np.max(drift) / history["kinetic"][0]))


def livelier(run):
    """Largest kinetic energy in the last tenth of the last stage over that in its first tenth [-]."""
    kinetic = run.history["kinetic"][run.history["stage"] == 1]
    tenth = len(kinetic) // 10
    return float(np.max(kinetic[-tenth:]) / np.max(kinetic[1 : tenth + 1]))


def unrest(run):
    """Largest kinetic energy in the last tenth over the energy that the heap would lose if it spread without limit [-]."""
    history = run.history
    return float(np.max(history["kinetic"][-len(history["kinetic"]) // 10 :]) / (history["mass"][0] * 9.81 * history["centre_y"][0]))


def free_fall(run):
    """Error of the velocity of a falling body, which is that of half a step before the time of its row, over its velocity at the end [-]."""
    history = run.history
    speed, fallen = -history["momentum_y"] / history["mass"], np.maximum(history["time"] - history["dt"] / 2, 0)
    return float(np.max(np.abs(speed - 9.81 * fallen)) / speed[-1])


def layer_error(run):
    """Error of the mean vertical stress in the middle of the upper layer, 5 < y < 7 m, over its closed form [-]."""
    frame = run.last_frame()
    height = frame["position"][:, 1] - frame["displacement"][:, 1]
    inside = (height > 5) & (height < 7)
    return abs(float(np.mean(frame["stress"][inside, 1]) / np.mean(-2000 * 9.81 * (8 - height[inside]))) - 1)


def finite(history):
    """Whether all entries are finite; the centre of mass alone may be empty, where no mass is left."""
    empty = history["mass"] == 0
    return all(np.all(np.isfinite(values) | (empty & name.startswith("centre_"))) for name, values in history.items())


def parted(run, alone):
    """Largest difference of the displacement of an edge between two runs, over its largest [-]."""
    if run.ending[0] or alone.ending[0]:
        return float("nan")
    here, there = run.history["edge_ux"], alone.history["edge_ux"]
    return float(np.max(np.abs(here - there)) / np.max(np.abs(there)))


# The extremes.


def grid(*axes):
    """Settings for a plain box: (low, high, cells) of each axis."""
    low, high, cells = zip(*axes)
    return {"mesh": {"grid": {"low": low, "high": high, "cells": cells}}}


def layers(stiff, dense):
    """A block of two halves that share a face, the lower one stiffer and denser by these factors."""
    velocity = ["0.2 + 0.5 * (x - 2) - 0.5 * (y - 2)", "0.1 + 0.5 * (x - 2)"]
    lower = {**RUBBER, "name": "lower", "youngs_modulus": 1.0e5 * stiff, "density": 1000 * dense}
    halves = (("upper", "rubber", [1, 2], [3, 3]), ("under", "lower", [1, 1], [3, 2]))
    return {"materials": [RUBBER, lower],
            "bodies": [{"name": name, "material": material, "shape": {"type": "box", "low": low, "high": high}, "particles_per_cell": 3,
                        "velocity": velocity} for name, material, low, high in halves]}


def body(low, high, velocity, count=3, **more):
    """Settings for one body in a box."""
    return {"bodies": [{"name": "block", "material": "rubber", "shape": {"type": "box", "low": low, "high": high}, "particles_per_cell": count,
                        "velocity": [str(v) for v in velocity], **more}]}


def broken_meshes(lab, full):
    """(name, scene, settings) of blocks in free flight on meshes of bad shape: flat cells, sizes that change, nodes that are moved."""
    side, steps = np.linspace(0, 4, 9), np.linspace(0, 4, 5)
    flat, solid = meshes.box([side, side]), meshes.box([steps, steps, steps])
    plan = []
    for angle in (30, 10, 3, 1, 0.1):
        plan.append((f"cells with angles of {angle:g} degrees", FLAT, meshes.written(lab, CASE, f"flat_{angle:g}", *meshes.slivered(*flat, angle, 7))))
    for angle in (10, 1, 0.1) if full else (10, 1):
        plan.append((f"cells with angles of {angle:g} degrees, 3-D", SOLID, meshes.written(lab, CASE, f"solid_{angle:g}", *meshes.slivered(*solid, angle, 7))))
    for ratio in (1.2, 1.5, 2, 4, 10):
        uneven = meshes.alternating(0, 4, 4, ratio)
        plan.append((f"cells in turn wide and narrow by {ratio:g}", FLAT, meshes.written(lab, CASE, f"turns_{ratio:g}", *meshes.box([uneven, uneven]))))
    for ratio in (2, 4, 10):
        jump = np.concatenate([side[:5], np.linspace(2, 4, 4 * ratio + 1)[1:]])
        mesh = meshes.written(lab, CASE, f"jump_{ratio:g}", *meshes.box([jump, jump]))
        plan.append((f"cells smaller by {ratio:g} beyond the middle", FLAT, {**mesh, "time.end": 1.0}))
    widths = np.geomspace(1, 0.1, 8)
    graded = np.concatenate([[0, 0.5, 1], 1 + 2 * np.cumsum(widths) / np.sum(widths), [3.1, 3.2, 3.5, 4]])
    plan.append(("cells smaller by 10 across the body, one by one", FLAT, meshes.written(lab, CASE, "smooth_10", *meshes.box([graded, side]))))
    for ratio, end in ((4, 1.0), (10, 0.5)):
        room, fine = {"type": "box", "low": [0, 0], "high": [4, 4]}, {"low": [2, 2], "high": [4, 4]}
        mesh = {"size": 0.5, "regions": [{"name": "all", "shape": room}], "refine": [{"within": fine, "size": 0.5 / ratio}]}
        plan.append((f"cells smaller by {ratio:g} in a box, by gmsh", FLAT, {"mesh": mesh, "time.end": end}))
    plan += [(f"nodes moved by {jitter:g} of the spacing", FLAT, {"mesh.grid.jitter": jitter}) for jitter in (0.3, 0.49)]
    over = np.where(np.arange(len(flat[1]))[:, None] % 2, flat[1], flat[1][:, ::-1])
    return [*plan, ("cells turned over", FLAT, meshes.written(lab, CASE, "turned", flat[0], over))]


def free_flights(lab, full):
    """(name, scene, settings) of blocks in free flight: they must not gain energy."""
    plan = [("plain", FLAT, {}), ("plain, 3-D", SOLID, {}), *broken_meshes(lab, full)]
    plan += [(f"{count} particles per cell", FLAT, {"bodies[0].particles_per_cell": count}) for count in (1, 4, 6, 12, 16, 25, 36, 64)]
    plan += [(f"{count} particles per cell, 3-D", SOLID, {"bodies[0].particles_per_cell": count}) for count in (1, 56)]
    for nu, averaged in ((0.49, True), (0.4999, True), (0.49999, True), (0.49999, False)):
        plan.append((f"nu {nu:g}, volumes {'' if averaged else 'not '}averaged", FLAT,
                     {"materials[0].poisson_ratio": nu, "bodies[0].f_bar": averaged, "time.end": 0.6}))
    for stiff, dense in ((1, 1e3), (1e6, 1e3), (1e6, 1)) if full else ((1, 1e3), (1e6, 1e3)):
        plan.append((f"stiffness by {stiff:g}, density by {dense:g} across a face", FLAT, {**layers(stiff, dense), "time.end": 1.0}))
    plan += [(f"CFL {cfl:g}", FLAT, {"time.cfl": cfl}) for cfl in (0.01, 0.1, 0.8, 1)]
    short = {"time.end": 1.5e-3, "outputs.history.every": 1e-5}
    plan += [("cells of 1 mm", FLAT, {**far(0), **short}), ("cells of 1 mm, coordinates of 1e6 m", FLAT, {**far(1e6), **short})]
    torn = {**grid((0, 16, 32), (0, 4, 8)), **body([7, 1], [9, 3], ["40 * (x - 8) / abs(x - 8)", "0"]), "time.end": 0.15}
    plan.append(("torn apart, cells empty", FLAT, torn))
    return plan + [(f"{name}, projected, aflip", scene, {**settings, **KERNELS["projected"]}) for name, scene, settings in plan if name in BESIDE]


def far(origin):
    """The free flight in cells of 1 mm whose coordinates begin at `origin` [m]."""
    x, y = (f"({letter} - {origin + 0.004!r})" for letter in "xy")
    return {**grid((origin, origin + 0.008, 8), (origin, origin + 0.008, 8)),
            **body([origin + 0.002] * 2, [origin + 0.006] * 2, [f"0.2 + 500 * {x} - 500 * {y}", f"0.1 + 500 * {x}"])}


def uniform_flights():
    """(name, scene, settings) of bodies in uniform motion: nothing may happen to them."""
    soft = {"materials[0].youngs_modulus": 1.0, "time.max_step": 0.25, "time.end": 4, "outputs.history.every": 0.25}
    long = {**grid((0, 32, 64), (0, 32, 64)), "mesh.grid.jitter": 0.3, "time.end": 50, "time.cfl": 1, "outputs.history.every": 1}
    drag = {**long, **body([1.1, 1.1], [1.3, 1.5], [0.37 * 1.5, 0.61 * 0.9], 1), "materials[0].youngs_modulus": 1.0e3}
    plan = [("particles on edges and vertices", FLAT, {**grid((0, 24, 8), (0, 24, 8)), **body([6, 6], [12, 12], [2, 1], 1), **soft}),
            ("particles on faces, edges and vertices, 3-D", SOLID,
             {**grid((0, 32, 8), (0, 32, 8), (0, 32, 8)), **body([4, 4, 4], [12, 12, 12], [3, 2, 1], 1), **soft}),
            ("one particle dragged past 100 nodes", FLAT, drag)]
    return [(f"{name}, {kernel}", scene, {**settings, **method}) for name, scene, settings in plan for kernel, method in KERNELS.items()]


def collisions():
    """(name, scene, settings) of what may turn a particle inside out: a block thrown at a wall faster than its waves, an implosion, a long step."""
    wall = {"boundaries": [{"type": "roller", "on": "boundary"}], "time.end": 0.3}
    return [*((f"thrown at a wall at Mach {mach:g}, {law}", FLAT, {"materials[0].law": law, **body([1, 1], [3, 3], [11.6 * mach, 0]), **wall})
              for law in ("neo_hookean", "corotated", "hencky", "linear_elastic") for mach in (2, 10)),
            *((f"implosion, {law}", FLAT, {"materials[0].law": law, **body([1, 1], [3, 3], ["-100 * (x - 2)", "-100 * (y - 2)"]), **wall})
              for law in ("neo_hookean", "linear_elastic")),
            ("CFL 2", FLAT, {"time.cfl": 2})]


def refusals(lab):
    """(name, scene, settings, exit status, words): what must not run, or not on."""
    side = np.linspace(0, 4, 9)
    nodes, cells = meshes.box([side, side])
    doubled, wrong = np.vstack([cells, [[0, 9, 11]]]), cells.copy()
    wrong[5] = [cells[5][0], cells[5][0], cells[5][2]]
    hole = nodes.copy()
    hole[40] = np.nan
    block = body([1, 1], [3, 3], [5, 0])
    return [("nu 0.5", FLAT, {"materials[0].poisson_ratio": 0.5}, 2, "outside (-1, 0.5)"),
            ("density 0", FLAT, {"materials[0].density": 0}, 2, "must be > 0"),
            ("angle of friction 90", HEAP, {"materials[0].friction_angle": 90}, 2, "outside [0, 90)"),
            ("CFL 0", FLAT, {"time.cfl": 0}, 2, "time.cfl"),
            ("CFL 2.5", FLAT, {"time.cfl": 2.5}, 2, "time.cfl"),
            ("2 particles per cell", FLAT, {"bodies[0].particles_per_cell": 2}, 2, "no symmetric set of 2 points"),
            ("empty body", FLAT, body([1.01, 1.01], [1.02, 1.02], [0, 0]), 2, "has no particles"),
            ("velocity 1 / 0", FLAT, body([1, 1], [3, 3], ["1 / 0", "0"]), 2, "is inf at"),
            ("velocity not a number", FLAT, body([1, 1], [3, 3], ["sqrt(-x)", "0"]), 2, "nan at"),
            ("cells with angles of 1e-9 degrees", FLAT, meshes.written(lab, CASE, "flat_1e-9", *meshes.slivered(nodes, cells, 1e-9, 7)), 2, "has no volume"),
            ("cells that overlap", FLAT, meshes.written(lab, CASE, "overlap", nodes, doubled), 2, ""),
            ("node twice in a cell", FLAT, meshes.written(lab, CASE, "node_twice", nodes, wrong), 2, "twice"),
            ("node that is not a number", FLAT, meshes.written(lab, CASE, "nan", hole, cells), 2, ""),
            ("step below the shortest", FLAT, {"time.min_step": 1}, 1, "below time.min_step"),
            ("escape", FLAT, block, 1, "is outside the mesh"),
            ("gravity stage without rest", HEAP, {"stages[0].duration": 0.02}, 1, "did not come to rest")]


def others(full):
    """(name, scene, settings, measure, bound, why) of what is expected to stay below a bound."""
    steps = 1e5 if full else 1e4
    methods = {"flip": tools.METHODS["umls, flip"], "tpic": tools.METHODS["umls, tpic"], "projected, aflip": KERNELS["projected"]}
    gravity = {"loads": [{"type": "gravity", "acceleration": [0, -9.81]}]}
    rest = {**gravity, **body([1, 0], [3, 2], [0, 0]), "boundaries": [{"type": "roller", "on": "y_min"}], "materials[0].youngs_modulus": 1.0e6,
            "time": {"cfl": 0.4, "max_step": 0.003}, "outputs.history.every": 0.03,
            "stages": [{"type": "geostatic", "duration": 10, "residual": 1.0e-3}, {"type": "run", "duration": steps * 0.003}]}
    plan = [(f"kinetic energy after {steps:g} steps at rest over that at their beginning, {name}", FLAT, {**rest, **method},
             livelier, 1.0, "a body at rest stays at rest") for name, method in methods.items()]
    plan += [(f"kinetic over potential energy of a heap after {steps:g} steps, {name}", HEAP,
              {"stages[1].duration": steps * 2.5e-3, **method}, unrest, 1e-8, "a heap with a slope below its angle of friction stays at rest")
             for name, method in methods.items()]
    plan += [(f"stress in the upper layer of a column, the lower stiffer by {stiff:g}, denser by {dense:g}, {kernel}", LAYERS,
              {"materials[1].youngs_modulus": 1e7 * stiff, "materials[1].density": 2e3 * dense, **KERNELS[kernel]}, layer_error, 0.05,
              "density times gravity times depth") for stiff, dense in ((1, 1), (1e6, 1e3)) for kernel in KERNELS]
    return [*plan, ("one particle: error of the velocity of fall", FLAT, {**gravity, **body([1.1, 3.1], [1.3, 3.5], [0, 0], 1), "time.end": 0.5},
                    free_fall, 1e-12, "a single particle falls freely"),
            ("escape: mass that is missing", FLAT, {**body([1, 1], [3, 3], [5, 0]), "on_exit": "delete"}, mass_drift, 1e-12,
             "mass is conserved, removed particles included")]


# Results.


def bounded(name, value, bound, why, run):
    """A result that must stay below a bound, with the program's words where the run failed."""
    status, words = run.ending
    return tools.Result(CASE, name, "-", value, "at most", bound, 0.0, why if status == 0 else f"{why}; ended with {status}: {words}", run)


def bounded_or_refused(name, run):
    """A run may fail with a reason, but not go on with energy from nowhere."""
    status, words = run.ending
    named = status == 1 and any(reason in words for reason in ("turned inside out", "not finite", "no finite stress", "outside the mesh"))
    value = 0.0 if named else tools.ended(run, gained if name.startswith("CFL") else gained_in_all)
    return bounded(f"energy gained, or 0 where the run was refused in words, {name}", value, 0.01, "bounded, or refused with a reason", run)


def refused(run, name, status, words, instead):
    """The exit status of a run that must be refused, or must fail; nan if the message does not contain the expected text."""
    code, said = run.ending
    told = f"expected text: {words or 'any error'}; printed: {said.splitlines()[0] if said else 'nothing'}"
    return tools.Result(CASE, f"exit status, {name}", "-", float(code) if words in said else float("nan"), "near", 0.0, float(status), told,
                        run if code < 2 else instead)


def draw(figure, runs):
    """Energy over time of some runs."""
    axis = figure.subplots()
    for name, run in runs:
        energy = run.history["kinetic"] + run.history["strain"]
        axis.plot(run.history["time"] / run.history["time"][-1], 1 + (energy - energy[0]) / inner(run.history), lw=1, label=name)
    axis.set(xlabel="time / end [-]", ylabel="energy over that to deform and spin [-]")
    axis.legend(fontsize=7)


def evaluate(lab):
    """All extremes: bounded ones, then refused ones, then what must hold of every run."""
    full = lab.level == "full"

    def start(name, scene, settings):
        return lab.run(scene, tools.label(name), settings, may_fail=True)

    free = [(name, start(name, scene, settings)) for name, scene, settings in free_flights(lab, full)]
    uniform = [(name, start(name, scene, settings)) for name, scene, settings in uniform_flights()]
    thrown = [(name, start(name, scene, settings)) for name, scene, settings in collisions()]
    like = {"materials[1].density": 1.0, "materials[1].youngs_modulus": 1e2}
    pairs = [(kernel, start(f"beside a heavy block, {kernel}", PAIR, method),
              start(f"beside its like, {kernel}", PAIR, {**method, **like})) for kernel, method in KERNELS.items()]
    further = [(start(name, scene, settings), name, *rest) for name, scene, settings, *rest in others(full)]
    wrong = [(start(name, scene, settings), name, *rest) for name, scene, settings, *rest in refusals(lab)]

    results = [bounded(f"energy gained, {name}", tools.ended(run, gained), 0.01, "a free body gains no energy", run) for name, run in free]
    results += [bounded(f"uniform motion disturbed, {name}", tools.ended(run, strayed), 1e-12, "no force acts", run) for name, run in uniform]
    results += [bounded_or_refused(name, run) for name, run in thrown]
    results += [bounded(f"motion of a light block changed by a heavy one that it never meets, {kernel}", parted(heavy, alike), 1e-6,
                        "the bodies do not collide", heavy) for kernel, heavy, alike in pairs]
    results += [bounded(name, tools.ended(run, measure), bound, why, run) for run, name, measure, bound, why in further]
    results += [refused(run, name, status, words, free[0][1]) for run, name, status, words in wrong]
    shown = ("plain", "cells with angles of 0.1 degrees", "cells in turn wide and narrow by 4", "nodes moved by 0.49 of the spacing",
             "1 particles per cell", "nu 0.49999, volumes averaged", "CFL 1", "torn apart, cells empty")
    pictured = [(name, run) for name, run in free if name in shown and run.ending[0] == 0]
    lab.figure(CASE, "verification_extremes", lambda figure: draw(figure, pictured),
               caption="Kinetic and strain energy of blocks in free flight under extremes.")
    return results + of_all(dict(free), [run for _, run in free + uniform], [run for _, run in thrown] + [run for run, *_ in further])


def of_all(free, alone, others_too):
    """What holds of every run that was started: mass, momentum, no number that is not one."""
    alone = [run for run in alone if run.ending[0] == 0]
    every, plain = alone + [run for run in others_too if run.ending[0] < 2], free["plain"]
    near, distant = free["cells of 1 mm"], free["cells of 1 mm, coordinates of 1e6 m"]
    shift = np.max(np.abs(near.history["kinetic"] - distant.history["kinetic"])) / inner(near.history) if distant.ending[0] == 0 else np.nan
    return [bounded("largest change of mass of all runs", max(mass_drift(run) for run in every), 1e-12, "mass is carried by particles", plain),
            bounded("largest change of momentum in free flight", max(momentum_drift(run) for run in alone), 1e-10, "no force acts", plain),
            bounded("histories with a number that is not finite", float(sum(not finite(run.history) for run in every)), 0.0, "never NaN", plain),
            bounded("kinetic energy at 1e6 m from the origin less that at the origin, cells of 1 mm", float(shift), 1e-3,
                    "positions are rounded to 1e-7 of a cell there, some hundred times", distant)]
