"""Generalized vortex: rings of an annulus turn against each other and back, driven by a body force given by formulas."""
import numpy as np

import lab as tools

CASE = "generalized_vortex"
SIZES = {"quick": [0.14, 0.1, 0.07], "full": [0.14, 0.1, 0.07, 0.05, 0.035]}  # m
FEW = {"quick": [0.14, 0.1], "full": [0.14, 0.1, 0.07, 0.05, 0.035]}  # of the small rotation
COARSE = {"quick": [0.2, 0.14], "full": [0.14, 0.1, 0.07]}  # of linear at the large one, which does not converge
MARKS = {"umls": "o-", "linear": "s--", "projected": "^-"}
FEWEST, MANY = 4, 12  # particles per cell: those of the comparison, and as many as it takes when they are drawn apart by several cells
KEPT = {"quick": [0.1, 0.07, 0.05], "full": [0.1, 0.07, 0.05, 0.035]}  # m, of bodies that keep their first reference
CRITERIA = {  # of renewals, from none kept to all
    "always": {"update": "always"}, "|J - 1| > 0.01": {"update": "adaptive", "volume_change": 0.01}, "strain > 0.05": {"update": "adaptive"},
    "strain > 0.5": {"update": "adaptive", "distortion": 0.5}, "strain > 5": {"update": "adaptive", "distortion": 5},
    "|J - 1| > 0.5": {"update": "adaptive", "volume_change": 0.5}, "never": {"update": "never"}}
AT = 0.07  # m, at which they are compared
SPLIT = {"quick": [0.1, 0.07, 0.05], "full": [0.1, 0.07, 0.05, 0.035]}  # m, of bodies whose particles are split
TURNS = [1, 0.1]  # rad, largest rotation: that of the literature, and one in which hardly any particle leaves its cell


def formulas(turn, data):
    """Initial velocity [m/s] and force per mass [m/s^2], as formulas of the place at the start and the time.

    The force has the components A_r and A_t in the frame that turns with the ring, R the radius, g(t) h(R) the rotation:
    A_r = mu/rho R (g h')^2 - R (g. h)^2,  A_t = R g.. h - mu/rho (3 g h' + R g h'').
    """
    modulus, nu, density = data["modulus [Pa]"], data["Poisson's ratio"], data["density [kg/m^3]"]
    speed, square = np.sqrt(modulus / density), modulus / (2 * (1 + nu)) / density  # c, mu / rho
    radius, angle = "sqrt(x^2 + y^2)", f"{speed:.17g} * pi * t"
    off = f"({radius} - 1)"
    h, h1, h2 = f"(1 - 32 * {off}^2 + 256 * {off}^4)", f"(-64 * {off} + 1024 * {off}^3)", f"(-64 + 3072 * {off}^2)"
    g, g1 = f"({turn} * sin({angle}))", f"({turn * speed:.17g} * pi * cos({angle}))"
    a_r = f"({square:.17g} * {radius} * ({g} * {h1})^2 - {radius} * ({g1} * {h})^2)"
    a_t = f"(-{radius} * ({speed:.17g} * pi)^2 * {g} * {h} - {square:.17g} * (3 * {g} * {h1} + {radius} * {g} * {h2}))"
    along, across = f"(x * {a_r} - y * {a_t})", f"(y * {a_r} + x * {a_t})"
    force = [f"(cos({g} * {h}) * {along} - sin({g} * {h}) * {across}) / {radius}", f"(sin({g} * {h}) * {along} + cos({g} * {h}) * {across}) / {radius}"]
    return [f"-{turn * speed:.17g} * pi * {h} * y", f"{turn * speed:.17g} * pi * {h} * x"], force


def exact(place, time, turn, data):
    """Displacement [m] of what was at `place`, shape (n, 2)."""
    off = np.hypot(*place.T) - 1
    angle = turn * np.sin(np.pi * np.sqrt(data["modulus [Pa]"] / data["density [kg/m^3]"]) * time) * (1 - 32 * off**2 + 256 * off**4)
    x, y = place.T
    return np.c_[np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y] - place


def errors_over_time(run, turn, data):
    """Times [s] and errors: root of the mean over the mass of the square of the error in displacement, over the same of the largest displacement."""
    times = run.frames.times
    found = []
    for frame, time in zip(run.frames, times):
        moved = frame["displacement"][:, :2].astype(float)
        place = frame["position"][:, :2] - moved
        size = np.average(np.sum(exact(place, 0.5, turn, data)**2, axis=1), weights=frame["mass"])
        found.append(np.sqrt(np.average(np.sum((moved - exact(place, time, turn, data))**2, axis=1), weights=frame["mass"]) / size))
    return times, found


def start(lab, kernel, turn, size, data, count=FEWEST, criterion=None, split=False):
    """Starts one run with `count` particles per cell, references that are renewed by one of CRITERIA, particles that are split."""
    velocity, force = formulas(turn, data)
    kept = {"bodies[0].reference": CRITERIA[criterion]} if criterion else {}
    kept |= {"bodies[0].resample": {}} if split else {}
    name = f"{kernel}_{turn}_dx{size}_{count}{'_reference' + str(list(CRITERIA).index(criterion)) if criterion else ''}{'_split' if split else ''}"
    return lab.run(f"{CASE}/scene.yaml", name, {
        **kept, "mesh.size": size, "bodies[0].particles_per_cell": count, "kernel": kernel, "transfer.scheme": tools.SUITED[kernel], "bodies[0].velocity": velocity,
        "loads[0].acceleration": force})


def judge_references(lab, data):
    """Results of few particles per cell that keep references, and a figure of error and time over the criterion."""
    source = data["source"]
    runs = {size: start(lab, "projected", 1, size, data, FEWEST, "never") for size in KEPT[lab.level]}
    by = {criterion: start(lab, "projected", 1, AT, data, FEWEST, criterion) for criterion in CRITERIA}
    errors = [max(errors_over_time(run, 1, data)[1]) for run in runs.values()]
    lab.convergence(CASE, "displacement error, projected, 1 rad, reference never renewed", list(runs), errors, expected=2)
    found = {criterion: (max(errors_over_time(run, 1, data)[1]), run.seconds) for criterion, run in by.items()}

    def draw_criteria(figure):
        left, right = figure.subplots(1, 2, sharey=True)
        for axes, which, label in ((left, 0, "error in displacement [%]"), (right, 1, "processor time [s]")):
            axes.barh(list(found), [value[which] * (1 if which else 100) for value in found.values()])
            axes.set_xlabel(label)
        left.invert_yaxis()

    lab.figure(CASE, "verification_vortex_references", draw_criteria, size=(7.4, 2.8),
               caption=f"Generalized vortex, projected, four particles per cell of {AT} m: error and time by the criterion of renewal.")
    return [tools.Result(CASE, "order of convergence, projected, 1 rad, reference never renewed", "-", tools.observed_order(list(runs), errors), "at least",
                         data["order asked"], 2.0, source, list(runs.values())[-1]),
            *(tools.Result(CASE, f"displacement error, projected, 1 rad, reference never renewed, cells of {size} m", "-", error, "reported", None, 0.0, source, run)
              for (size, run), error in zip(runs.items(), errors)),
            *(tools.Result(CASE, f"displacement error, projected, 1 rad, cells of {AT} m, renewed where {criterion}", "-", found[criterion][0], "reported", None, 0.0,
                           source, run) for criterion, run in by.items())]


def judge_resampling(lab, data):
    """Results of few particles per cell that are split where shear draws them apart, by kernel, and the curves of errors."""
    results, curves = [], {}
    for kernel in ("projected", "umls"):
        runs = {size: start(lab, kernel, 1, size, data, split=True) for size in SPLIT[lab.level]}
        errors = [max(errors_over_time(run, 1, data)[1]) for run in runs.values()]
        name = f"{kernel}, 1 rad, particles split"
        curves[name] = MARKS[kernel][0] + ":", list(runs), errors
        lab.convergence(CASE, f"displacement error, {name}", list(runs), errors, expected=2)
        results += [tools.Result(CASE, f"displacement error, {name}, cells of {size} m", "-", error, "reported", None, 0.0, data["source"], run)
                    for (size, run), error in zip(runs.items(), errors)]
        results += [tools.Result(CASE, f"particles at the end over those at the start, {name}, cells of {size} m", "-",
                                 len(run.frames[-1]["mass"]) / len(run.frames[0]["mass"]), "reported", None, 0.0, data["source"], run) for size, run in runs.items()]
        judged = kernel == "projected"
        results.append(tools.Result(CASE, f"order of convergence, {name}", "-", tools.observed_order(list(runs), errors), "at least" if judged else "reported",
                                    data["order asked"] if judged else None, 2.0, data["source"], list(runs.values())[-1]))
    return results, curves


def draw(figure, curves, run, data):
    """Left error over size, right particles of one run at half time, those of a sector that was straight in black."""
    left, right = figure.subplots(1, 2, width_ratios=[1.2, 1])
    for name, (mark, sizes, errors) in curves.items():
        left.loglog(sizes, np.array(errors) * 100, mark, label=name)
    left.loglog([0.14, 0.07], [20, 5], "k:", label="order 2")
    tools.size_axis(left, SIZES["quick"] + [0.05])
    left.set_ylabel("error in displacement [%]")
    left.set_ylim(bottom=0.3)  # room for the names
    left.legend(fontsize=6, ncols=2, loc="lower center")
    frame = run.frames[len(run.frames) // 2]
    place = frame["position"] - frame["displacement"]
    sector = np.abs(np.arctan2(place[:, 1], place[:, 0])) < 0.1
    right.plot(*frame["position"][:, :2].T, ".", color="0.85", markersize=1)
    right.plot(*frame["position"][sector, :2].T, "k.", markersize=2, label="talus")
    radius = np.linspace(0.75, 1.25, 200)
    line = np.c_[radius, 0 * radius]
    right.plot(*(line + exact(line, 0.5, 1, data)).T, "C1-", label="exact")
    right.set(aspect="equal", xlim=(0, 1.4), ylim=(-0.3, 1.2), xlabel="x [m]", title="a sector that was straight, at 0.5 s")
    right.legend()


def evaluate(lab):
    """Results for three kernels and two rotations, and for many particles; judged is the order at the rotation of the literature, of umls with few and of projected with many."""
    data, results, curves = tools.reference(CASE), [], {}
    plan = {(kernel, turn, FEWEST): {size: start(lab, kernel, turn, size, data) for size in (FEW if turn < 1 else COARSE if kernel == "linear" else SIZES)[lab.level]}
            for turn in TURNS for kernel in tools.SUITED}
    plan["projected", 1, MANY] = {size: start(lab, "projected", 1, size, data, MANY) for size in SIZES[lab.level]}
    for (kernel, turn, count), runs in plan.items():
        errors = [max(errors_over_time(run, turn, data)[1]) for run in runs.values()]
        name = f"{kernel}, {turn} rad" + (f", {count} particles per cell" if count != FEWEST else "")
        judged = turn == 1 and (kernel, count) in (("umls", FEWEST), ("projected", MANY))
        curves[name] = MARKS[kernel] if count == FEWEST else "D-", list(runs), errors
        results += [tools.Result(CASE, f"displacement error, {name}, cells of {size} m", "-", value, "reported", None, 0.0, data["source"], run)
                    for (size, run), value in zip(runs.items(), errors)]
        results.append(tools.Result(CASE, f"order of convergence, {name}", "-", tools.observed_order(list(runs), errors), "at least" if judged else "reported",
                                    data["order asked"] if judged else None, 2.0, data["source"], list(runs.values())[-1]))
        lab.convergence(CASE, f"displacement error, {name}", list(runs), errors, expected=2)
    split, of_split = judge_resampling(lab, data)
    curves |= of_split
    lab.figure(CASE, "verification_vortex", lambda figure: draw(figure, curves, list(plan["projected", 1, MANY].values())[-1], data), size=(7.4, 3.2),
               caption="Generalized vortex: error of the displacement, and a sector of the ring at the largest rotation.")
    return results + split + judge_references(lab, data)
