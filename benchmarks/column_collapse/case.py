"""Columns that collapse: aluminium bars against one experiment, granular columns in a channel and round ones against the laws of others, and
those with the rheology mu(I) (inertial.py)."""
import numpy as np
from matplotlib.ticker import NullLocator

import lab as tools

CASE = "column_collapse"
SIZE = {"quick": 0.1 / 12, "full": 0.004}  # m, cells
STRIP = 0.01  # m, over which the surface is averaged
SCORED = 0.4  # m, where the surface is compared: from the wall to here
MOVED = 0.002  # m, more than the width of a bar: what counts as moved
FLOOR = "{type: friction, on: y_min, coefficient: 0.36}"  # tan 19.8 deg, the friction of the bars
VARIANTS = {
    "drucker_prager": {},
    "mohr_coulomb": {"materials": "[{name: bars, law: mohr_coulomb, density: 2650, youngs_modulus: 0.84e6, poisson_ratio: 0.3, "
                                  "friction_angle: 19.8, cohesion: 0}]"},
    "drucker_prager, linear kernel": {"kernel": "linear", "transfer.scheme": "flip"},  # tpic does not survive with this kernel
    "drucker_prager, projected, aflip": tools.METHODS["projected, aflip"],
    "drucker_prager, floor with friction": {"boundaries[0]": FLOOR},
    "drucker_prager, floor with friction, projected, aflip": {"boundaries[0]": FLOOR, **tools.METHODS["projected, aflip"]},
    "drucker_prager, outer": {"materials[0].match": "outer"},
    "drucker_prager, flip": {"transfer.scheme": "flip"},
}
JUDGED = {"drucker_prager", "mohr_coulomb", "drucker_prager, projected, aflip"}  # on a rough floor, with the strength of plane strain
FULL_ONLY = {"drucker_prager, linear kernel", "drucker_prager, outer", "drucker_prager, flip", "drucker_prager, floor with friction",
             "drucker_prager, floor with friction, projected, aflip"}
WIDTH = 0.1  # m, of the columns in the channel before they are released
COLUMNS = {  # height over width: cells over the width, room over the width, level
    0.5: (12, 3, "quick"), 1: (12, 5, "quick"), 4: (8, 13, "full"), 6: (8, 18, "full")}
FALLS = 10  # times of free fall over the height, after which everything is at rest
ROUND = {0.5: 12, 1: 8}  # height over radius of the round columns: cells over the radius; full level alone
RINGS = 20  # annuli over the radius before, of which the deposit is averaged


def surface(frame, strip=STRIP):
    """Height of the mass [m] over strips (x of their middles, y): area of the particles, taken as squares, over the width of a strip."""
    x, half = frame["position"][:, 0], np.sqrt(frame["volume"]) / 2
    edges = np.arange(0, x.max() + 3 * strip, strip)
    left, right = x - half, x + half
    area = np.zeros(len(edges) - 1)
    for i, (low, high) in enumerate(zip(edges, edges[1:])):
        share = np.clip(np.minimum(right, high) - np.maximum(left, low), 0, None) / (right - left)
        area[i] = np.sum(share * frame["volume"])
    return (edges[:-1] + edges[1:]) / 2, area / strip


def farthest(x, y, height):
    """Farthest x [m] at which the surface is `height` high."""
    last = int(np.nonzero(y > height)[0][-1])
    return float(np.interp(height, [y[last + 1], y[last]], [x[last + 1], x[last]]))


def failure_line(frame):
    """Line between what moved and what did not, at places before the collapse: x [m] at heights y, and where it meets the floor."""
    start = frame["position"] - frame["displacement"]
    moved = np.linalg.norm(frame["displacement"], axis=1) > MOVED
    heights = np.arange(0.015, 0.1, 0.01)
    line = np.array([start[moved & (np.abs(start[:, 1] - y) < 0.005), 0].min() for y in heights])
    return line, heights, float(np.polyval(np.polyfit(heights, line, 1), 0))


def measures(run, data):
    """What is compared, by name: (unit, value)."""
    frame, points, line = run.last_frame(), data["surface"], failure_line(run.last_frame())
    x, y = surface(frame)
    between = (data["failure"]["y"] >= line[1][0]) & (data["failure"]["y"] <= line[1][-1])
    compared = {"x": data["failure"]["x"][between], "y": data["failure"]["y"][between]}
    inside = points["x"] <= SCORED
    return {
        "rms": tools.rms(np.interp(points["x"][inside], x, y) - points["y"][inside]),
        "centimetre": farthest(x, y, 0.01),
        "toe": farthest(x, y, data["toe height [m]"]),
        "foot": line[2],
        "line": tools.rms(np.interp(compared["y"], line[1], line[0]) - compared["x"]),
        "speed": float(np.sqrt(np.average(np.sum(frame["velocity"]**2, axis=1), weights=frame["mass"])))}


def judge(name, run, data, judged):
    """Results of one run; `judged` says whether surface and toe have a verdict, the rest is reported."""
    found = measures(run, data)
    seen, line, sharp = data["surface source"], data["failure source"], data["digitising [m]"]

    def report(metric, unit, value, reference, source, criterion="reported", tolerance=None):
        return tools.Result(CASE, f"{metric}, {name}", unit, value, criterion, tolerance, reference, source, run)

    return [
        report("rms of the surface over 0 < x < 40 cm", "m", found["rms"], 0.0, seen, *(("at most", sharp) if judged else ())),
        report("x at height 1 cm", "m", found["centimetre"], data["x at height 1 cm [m]"], seen, *(("near", sharp) if judged else ())),
        report("toe, x at height 1.5 mm", "m", found["toe"], data["toe x [m]"], seen, *(("within", data["toe slack"]) if judged else ())),
        report("foot of the line of failure", "m", found["foot"], data["foot of failure line x [m]"], line),
        report("line of failure, rms of its distance in x", "m", found["line"], 0.0, line),
        report("speed at the end, rms", "m/s", found["speed"], None, "")]


def draw(figure, runs, data):
    """Left surfaces, right lines of failure, over the experiment."""
    left, right = figure.subplots(1, 2, width_ratios=[2, 1], sharey=True)
    left.plot([0, 20, 20], [10, 10, 0], color="0.7", label="before")
    for name, run in runs.items():
        frame = run.last_frame()
        x, y = surface(frame)
        left.plot(100 * x, 100 * y, "--" if name == "mohr_coulomb" else "-", label=name)
        line, heights, _ = failure_line(frame)
        right.plot(100 * line, 100 * heights, "--" if name == "mohr_coulomb" else "-")
    left.plot(100 * data["surface"]["x"], 100 * data["surface"]["y"], "k.", label="experiment")
    right.plot(100 * data["failure"]["x"], 100 * data["failure"]["y"], "k.")
    left.set(xlim=(0, 55), ylim=(0, 10.5), xlabel="x [cm]", ylabel="y [cm]", title="final surface")
    right.set(xlim=(0, 22), xlabel="x before the collapse [cm]", title="line of failure")
    left.legend()


def channel(lab, ratio, method=None):
    """The run of a column in the channel, `ratio` times as high as wide, with the method of the scene or another."""
    cells, room, _ = COLUMNS[ratio]
    height, end = round(ratio * WIDTH, 3), round(FALLS * (ratio * WIDTH / 9.81)**0.5, 3)
    top = round(height + 0.02, 3)
    return lab.run(f"{CASE}/channel.yaml", f"channel_{ratio}{'_' + tools.label(method) if method else ''}", {
        **tools.METHODS.get(method, {}),
        "mesh.size": round(WIDTH / cells, 5), "mesh.regions[0].shape.high": [WIDTH, height], "mesh.regions[1].shape.low": [0, height],
        "mesh.regions[1].shape.high": [WIDTH, top], "mesh.regions[2].shape.high": [round(room * WIDTH, 3), top],
        "stages[1].duration": end, "outputs.particles.every": end})


def deposit(run):
    """Run-out (L - L0) / L0 to where the deposit is one particle high, the same to 99 % of the mass, and its height at the wall over L0."""
    frame = run.last_frame()
    x, y = surface(frame, WIDTH / 10)
    spacing = float(np.sqrt(np.mean(frame["volume"])))
    return farthest(x, y, spacing) / WIDTH - 1, run.history["front"][-1] / WIDTH - 1, y[0] / WIDTH


def laws(ratio, own):
    """Run-out over L0 by the laws of the two experiments of a kind of column, the smaller one first."""
    branch = "short" if ratio < 2 else "tall"
    return sorted(law[branch][0] * ratio**law[branch][1] for law in own["run-out"].values())


def band(ratio, own):
    """Middle and half width of the band between the two laws, widened by the slack."""
    low, high = laws(ratio, own)
    low, high = (1 - own["slack"]) * low, (1 + own["slack"]) * high
    return (low + high) / 2, (high - low) / 2


def judge_channel(name, ratio, run, data):
    """Results of one column; the run-out of short ones is asked to lie in the band between the two laws, widened by 10 %."""
    own, (front, mass, height) = data["channel"], deposit(run)
    middle, half = band(ratio, own)
    short, kept = ratio <= 1, ratio <= own["height kept up to"]
    return [
        tools.Result(CASE, f"run-out (L - L0) / L0, {name}", "-", front,
                     *(("near", half) if short else ("reported", None)), middle, own["source"], run),
        tools.Result(CASE, f"the same to 99 % of the mass, {name}", "-", float(mass), "reported", None, None, own["source"], run),
        tools.Result(CASE, f"final height at the wall over L0, {name}", "-", float(height),
                     *(("within", own["slack"]) if kept else ("reported", None)),
                     ratio if kept else None, own["source"], run)]


def quarter(lab, ratio):
    """The run of a quarter of a round column, `ratio` times as high as its radius, with the default kernel."""
    height, end = round(ratio * WIDTH, 3), round(6 * (ratio * WIDTH / 9.81)**0.5, 3)
    reach = round(WIDTH * (1.6 + 1.4 * ratio), 3)
    return lab.run(f"{CASE}/quarter.yaml", f"round_{ratio}", {
        "mesh.size": round(WIDTH / ROUND[ratio], 5),
        "bodies[0].shape.to": [0, height, 0], "mesh.regions[0].shape.high": [reach, round(height + 0.015, 3), reach],
        "stages[1].duration": end, "outputs.particles.every": end})


def round_deposit(run):
    """Run-out (R - R0) / R0 of a quarter to where its annuli are one particle high on average, and the height on the axis over R0."""
    frame = run.last_frame()
    radius, volume = np.hypot(frame["position"][:, 0], frame["position"][:, 2]), frame["volume"]
    edges = np.arange(0, radius.max() + 3 * WIDTH / RINGS, WIDTH / RINGS)
    height = np.histogram(radius, edges, weights=volume)[0] / (np.pi / 4 * np.diff(edges**2))
    spacing = float(np.mean(volume) ** (1 / 3))
    inner = radius < WIDTH / 5
    return farthest((edges[:-1] + edges[1:]) / 2, height, spacing) / WIDTH - 1, (float(np.max(frame["position"][inner, 1])) + spacing / 2) / WIDTH


def judge_round(ratio, run, data):
    """Results of one round column."""
    own, (front, height) = data["round"], round_deposit(run)
    middle, half = band(ratio, own)
    return [tools.Result(CASE, f"run-out (R - R0) / R0, round, a = {ratio}, projected, aflip", "-", front, "near", half, middle, own["source"], run),
            tools.Result(CASE, f"final height on the axis over R0, round, a = {ratio}, projected, aflip", "-", height,
                         *(("within", own["slack"]) if ratio <= own["height kept up to"] else ("reported", None)),
                         ratio if ratio <= own["height kept up to"] else None, own["source"], run)]


def draw_channel(figure, runs, data):
    """Left deposits, right run-outs over the ratio with the laws of both experiments."""
    left, right = figure.subplots(1, 2, width_ratios=[2, 1])
    for (name, line, mark), columns in zip((("umls, tpic", "-", "o"), ("projected, aflip", "--", "x")), runs):
        for number, (ratio, run) in enumerate(columns.items()):
            x, y = surface(run.last_frame(), WIDTH / 5)
            left.plot(x / WIDTH, y / WIDTH, line, color=f"C{number}", label=f"a = {ratio}, {name}")
            right.plot(ratio, deposit(run)[0], mark, color="k", fillstyle="none", label=name if ratio == 0.5 else None)
    for colour, (name, law) in enumerate(data["channel"]["run-out"].items()):
        for branch, ends in (("short", [0.4, 1.8]), ("tall", [3, 7])):
            ratios = np.linspace(*ends, 20)
            right.plot(ratios, law[branch][0] * ratios**law[branch][1], color=f"C{colour}", label=name if branch == "short" else None)
    left.set(xlabel="x / L$_0$", ylabel="y / L$_0$", title="deposits")
    right.set(xscale="log", yscale="log", ylim=(0.3, 30), xlabel="a = H$_0$ / L$_0$", title="(L - L$_0$) / L$_0$")
    right.set_xticks(list(COLUMNS), [str(ratio) for ratio in COLUMNS])
    right.xaxis.set_minor_locator(NullLocator())
    left.legend()
    right.legend(fontsize=7)


def evaluate(lab):
    """Results of the bars with both laws, other kernels and another floor, and of the columns in the channel with two kernels; more variants, taller
    columns, round ones and more of those with mu(I) at full level."""
    data = {**tools.reference(CASE), "surface": tools.reference(CASE, "surface.csv"), "failure": tools.reference(CASE, "failure.csv")}
    runs = {}
    for name, changes in VARIANTS.items():
        if lab.level == "full" or name not in FULL_ONLY:
            runs[name] = lab.run(f"{CASE}/scene.yaml", tools.label(f"{name}_{lab.level}"), {"mesh.size": SIZE[lab.level], **changes})
    asked = [ratio for ratio, (_, _, level) in COLUMNS.items() if level in ("quick", lab.level)]
    columns = {ratio: channel(lab, ratio) for ratio in asked}
    besides = {ratio: channel(lab, ratio, "projected, aflip") for ratio in asked}
    rounds = {ratio: quarter(lab, ratio) for ratio in ROUND} if lab.level == "full" else {}
    inertial = tools.module(CASE, "inertial")
    inertial_runs = inertial.plan(lab)
    runs = tools.ends(runs)
    lab.figure(CASE, "verification_bars", lambda figure: draw(figure, runs, data), size=(7.6, 3),
               caption="Column of aluminium bars: final surface and line of failure over the experiment of Bui et al. 2008.")
    lab.figure(CASE, "verification_channel", lambda figure: draw_channel(figure, (columns, tools.ends(besides)), data), size=(7.6, 3),
               caption="Granular columns in a channel: deposits, and run-outs beside the laws of two experiments.")
    results = [result for name, run in runs.items() for result in judge(name, run, data, name in JUDGED)]
    results += [result for ratio, run in columns.items() for result in judge_channel(f"channel, a = {ratio}", ratio, run, data)]
    results += [result for ratio, run in tools.ends(besides).items() for result in judge_channel(f"channel, a = {ratio}, projected, aflip", ratio, run, data)]
    results += [result for ratio, run in tools.ends(rounds).items() for result in judge_round(ratio, run, data)]
    return results + inertial.measure(lab, inertial_runs)


def tradeoff(lab):
    """Error of the final surface of the bars against the experiment, which its digitising limits to some per cent."""
    points = tools.reference(CASE, "surface.csv")
    inside = points["x"] <= SCORED

    def error(run):
        x, y = surface(run.last_frame())
        return tools.rms(np.interp(points["x"][inside], x, y) - points["y"][inside]) / 0.1  # of the height before

    return tools.Tradeoff(
        scene=f"{CASE}/scene.yaml",
        axes={"mesh": {f"{count} cells over the height": {"mesh.size": round(0.1 / count, 5)} for count in ([6, 8, 12] if lab.level == "quick" else [6, 8, 12, 16, 25])},
              "particles": {f"{count} particles": {"bodies[0].particles_per_cell": count} for count in (4, 3, 6)},
              "method": tools.METHODS,
              "step": {f"CFL {share}": {"time.cfl": share} for share in (0.5, 0.25)}},
        error=error,
        what="rms error of the final surface of a column of bars over its height")
