"""A rubber bar pulled slowly to four times its length: whether it stays in one piece, for each choice of the reference configuration, against the closed form."""
import numpy as np

import fields
import lab as tools

CASE = "pulled_bar"
SIZES = {0.0625: "quick", 0.03125: "quick", 0.015625: "full"}  # m: 4, 8 and 16 cells over the height
ENDS = [4.65, 4.73, 4.86]  # m: gmsh then makes other triangles
ROOM = 0.53  # m, height of the room: no row of nodes is meant to follow the bar
COARSE, FINE = 0.0625, 0.03125  # m: of the runs with other choices
UPDATES = {"never": "{update: never}", "adaptive": "{update: adaptive}", "always": "{update: always}"}
ADAPTIVE = {"adaptive, distortion 0.5": "{update: adaptive, distortion: 0.5}", "adaptive, distortion 2": "{update: adaptive, distortion: 2}",
            "adaptive, volume_change 0.5": "{update: adaptive, volume_change: 0.5}"}
OFF = 0.3  # a particle is off where its stretch differs by more than this share of the exact one
JITTER = 0.3  # of the spacing of a grid of squares, each cut in two triangles
TORN = 0.01  # the bar is torn where so large a share of the mass is off


def root(function, low, high):
    """Where a growing function is zero, by bisection."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if function(middle) > 0 else (middle, high)
    return (low + high) / 2


def first_piola(stretch, data):
    """Nominal stress [Pa] at a stretch along the bar, its side free."""
    young, nu = data["youngs_modulus [Pa]"], data["poisson_ratio"]
    mu, lame = young / 2 / (1 + nu), young * nu / (1 + nu) / (1 - 2 * nu)
    across = root(lambda b: mu * (b**2 - 1) + lame * np.log(stretch * b), 1e-3, 1.0)
    return (mu * (stretch**2 - 1) + lame * np.log(stretch * across)) / stretch


def exact(time, data):
    """Stretch along the bar under the load there is at a time: it grows smoothly over the ramp."""
    share = min(time / data["ramp [s]"], 1)
    load = share**2 * (3 - 2 * share) * data["traction [Pa]"]
    return root(lambda stretch: first_piola(stretch, data) - load, 1.0, 10.0)


def stretches(frame):
    """F_xx of the particles."""
    return frame["F"].reshape(-1, 9)[:, 0]


def off(frame, stretch):
    """Share of the mass whose stretch is off."""
    return float(np.average(np.abs(stretches(frame) / stretch - 1) > OFF, weights=frame["mass"]))


def scatter(frame, stretch):
    """Root of the mean square error of the stretch over the mass, relative."""
    return float(np.sqrt(np.average((stretches(frame) / stretch - 1)**2, weights=frame["mass"])))


def tip_error(frame, stretch, data):
    """Error of the displacement of the middle of the end, relative: a linear field fitted to the twelve particles nearest to it at the start."""
    start, at = frame["position"][:, :2] - frame["displacement"][:, :2], np.array([data["length [m]"], data["height [m]"] / 2])
    moved = fields.extended(start, frame["displacement"][:, :2], at)[0]
    return float(abs(moved / ((stretch - 1) * data["length [m]"]) - 1))


def torn(run, data):
    """Exact stretch at the first frame in which the bar is torn, or at the last one if it is in none."""
    for frame, time in zip(run.frames, run.frames.times):
        if off(frame, exact(time, data)) > TORN:
            break
    return exact(time, data)


def judge(name, run, data, asked):
    """Results of a run; `asked` of those that hold together."""
    if run.ending[0]:
        return [tools.Result(CASE, f"stretch at which it tears, {name}", "-", torn(run, data), "reported", None, exact(data["ramp [s]"], data), data["source"], run)]
    frame, stretch = run.last_frame(), exact(data["ramp [s]"], data)
    limit = {True: ("at most", data["slack"]), False: ("reported", None)}[asked]
    none = {True: ("at most", data["largest share of the mass that is off"]), False: ("reported", None)}[asked]
    return [tools.Result(CASE, f"error of the displacement of the tip, {name}", "-", tip_error(frame, stretch, data), *limit, 0.0, data["source"], run),
            tools.Result(CASE, f"root mean square error of the stretch, {name}", "-", scatter(frame, stretch), "reported", None, 0.0, data["source"], run),
            tools.Result(CASE, f"share of the mass whose stretch is off by 30 %, {name}", "-", off(frame, stretch), *none, 0.0, data["source"], run)]


def draw(figure, runs, data):
    """Left the particles, above at the end without renewal, below where the bar tears with it; right the share of the mass that is off."""
    left, right = figure.subfigures(1, 2, width_ratios=[1.7, 1])
    axes = left.subplots(2, 1, sharex=True)
    for axis, name in zip(axes, ["never", "always"]):
        run = runs[name]
        frame, time = run.last_frame(), run.frames.times[-1]
        stretch = exact(time, data)
        dots = axis.scatter(frame["position"][:, 0], frame["position"][:, 1], c=stretches(frame) / stretch, s=3, vmin=0.5, vmax=1.5, cmap="coolwarm")
        axis.axvline(stretch * data["length [m]"], color="k", linestyle=":", linewidth=0.8)
        axis.set(title=f"update: {name}, load for stretch {stretch:.2f}", xlim=(0, 4.7), ylim=(0, 0.3), ylabel="y [m]")
    axes[-1].set(xlabel="x [m]")
    left.colorbar(dots, ax=axes, label="stretch of the particles over the exact one", location="bottom", shrink=0.7, extend="both")
    axis = right.subplots()
    for (name, run), line in zip(runs.items(), ["-", "--", ":"]):
        known = [exact(time, data) for time in run.frames.times]
        axis.plot(known, [100 * off(frame, stretch) for frame, stretch in zip(run.frames, known)], "." + line, label=name)
    axis.set(xlabel="exact stretch under the load", ylabel="mass whose stretch is off by 30 % [%]")
    axis.legend(title="update")


def evaluate(lab):
    """The bar with each choice of reference, on several meshes; with other kernels and criteria."""
    data = tools.reference(CASE)

    def start(name, size, reference, end=ENDS[0], **more):
        settings = {"mesh.size": size, "mesh.regions[0].shape.high": [end, ROOM], "bodies[0].reference": reference, **more}
        return lab.run(f"{CASE}/scene.yaml", tools.label(name), settings, may_fail=reference != UPDATES["never"])

    def start_jittered(name, size, reference):
        grid = f"{{grid: {{low: [0, 0], high: [{ENDS[0]}, {ROOM}], cells: [{round(ENDS[0] / size)}, {round(ROOM / size)}], jitter: {JITTER}}}}}"
        return lab.run(f"{CASE}/scene.yaml", tools.label(name), {"mesh": grid, "bodies[0].reference": reference}, may_fail=reference != UPDATES["never"])

    judged, reported = {}, {}
    for size in [size for size in SIZES if lab.level == "full" or SIZES[size] == "quick"]:
        for end in ENDS:
            name = f"never, cells of {size} m, room of {end} m"
            judged[name] = start(name, size, UPDATES["never"], end)
        for update in ("adaptive", "always"):
            name = f"{update}, cells of {size} m"
            reported[name] = start(name, size, UPDATES[update])
    for end in ENDS[1:]:
        name = f"always, cells of {COARSE} m, room of {end} m"
        reported[name] = start(name, COARSE, UPDATES["always"], end)
    for name, reference in ADAPTIVE.items():
        reported[name] = start(name, COARSE, reference)
    for update in ("never", "always"):
        name = f"{update}, 12 particles a cell"
        reported[name] = start(name, COARSE, UPDATES[update], **{"bodies[0].particles_per_cell": 12})
    for size in [COARSE, FINE] if lab.level == "full" else [COARSE]:
        for update in ("never", "always"):
            name = f"{update}, nodes moved at random, squares of {size} m"
            reported[name] = start_jittered(name, size, UPDATES[update])
    for kernel in ("umls", "linear"):
        for update, reference in UPDATES.items():
            name = f"{update}, {kernel}, {tools.SUITED[kernel]}"
            reported[name] = start(name, COARSE, reference, kernel=kernel, **{"transfer.scheme": tools.SUITED[kernel]})
    results = [result for name, run in tools.ends(judged).items() for result in judge(name, run, data, True)]
    results += [result for name, run in tools.ends(reported).items() for result in judge(name, run, data, False)]
    shown = {"never": judged[f"never, cells of {COARSE} m, room of {ENDS[0]} m"]}
    shown |= {update: reported[f"{update}, cells of {COARSE} m"] for update in ("adaptive", "always")}
    lab.figure(CASE, "verification_pulled_bar", lambda figure: draw(figure, shown, data), size=(8.6, 3.4),
               caption="A bar under a growing dead load, its reference kept (never) or renewed in each step (always); dotted: exact end.")
    sizes, stretch = [size for size in SIZES if f"never, cells of {size} m, room of {ENDS[0]} m" in judged], exact(data["ramp [s]"], data)
    errors = [np.mean([scatter(judged[f"never, cells of {size} m, room of {end} m"].last_frame(), stretch) for end in ENDS]) for size in sizes]
    lab.convergence(CASE, "root mean square error of the stretch, never, mean of three meshes", sizes, errors)
    return results
