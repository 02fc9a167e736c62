"""Columns of grains with the rheology mu(I), beside a solution of the Navier-Stokes equations with it, discs, and laws of the run-out."""
import numpy as np
from matplotlib.ticker import NullLocator

import lab as tools

CASE = "column_collapse"
case = tools.module(CASE)
COLUMNS = {  # height over width: cells over the height of 1 m and their level, grains over the height, room in heights
    0.5: ({10: "quick", 16: "full", 24: "full"}, 30, 5.5),
    1.42: ({12: "quick", 20: "quick", 32: "full"}, 65, 4.5),
    6.26: ({24: "quick", 40: "full", 64: "full"}, 134, 3.5)}
WIDER = (0.03, 0.06)  # m, by which the room is wider on two other meshes with the middle cells: gmsh then makes other triangles
FALL = 9.81**-0.5  # s, sqrt(H0 / g): the columns are released after it
END, TIMES = 8, (1, 2, 3, 4)  # of it, after the release
STRIP = 0.1  # m, over which surfaces are averaged


def start(lab, ratio, cells, wider=0.0, name="", **changes):
    """The run of a column of 1 m height, `ratio` times as high as wide, with so many cells over the height."""
    _, grains, room = COLUMNS[ratio]
    width = round(1 / ratio, 4)
    return lab.run(f"{CASE}/inertial.yaml", tools.label(f"inertial_{ratio}_{cells}{f'_{wider}' if wider else ''}{name}"), {
        "mesh.size": round(1 / cells, 6), "mesh.regions[0].shape.high": [round(room + wider, 3), 1.1], "bodies[0].shape.high": [width, 1],
        "materials[0].grain_diameter": round(1 / grains, 6), **changes})


def plan(lab):
    """Runs of this level: {(ratio, cells, what differs): run}."""
    runs = {}
    for ratio, (sizes, _, _) in COLUMNS.items():
        for number, (cells, level) in enumerate(sizes.items()):
            if level in ("quick", lab.level):
                runs[ratio, cells, ""] = start(lab, ratio, cells)
            if number == 1 and lab.level == "full":
                runs |= {(ratio, cells, f", room wider by {wider} m"): start(lab, ratio, cells, wider) for wider in WIDER}
    if lab.level == "full":
        floor = {"boundaries[0]": "{type: friction, on: y_min, coefficient: 0.32}"}  # mu_s, the friction of the grains at rest
        runs[1.42, 20, ", floor with friction 0.32"] = start(lab, 1.42, 20, name="_friction", **floor)
    return runs


def frame(run, time):
    """The particles at so many sqrt(H0 / g) after the release."""
    return run.frames.at((1 + time) * FALL)


def profile(data, ratio, time):
    """x and y of the reference [m] at a time; 99 is that of the deposit."""
    chosen = (data["ratio"] == ratio) & (data["t"] == time)
    return data["x"][chosen], data["y"][chosen]


def last(data, ratio):
    """The last time of the reference, and that of the run at which it is compared."""
    time = int(np.max(data["t"][data["ratio"] == ratio]))
    return time, min(time, END)


def difference(run, data, ratio, time, reference):
    """Root mean square difference of the surface over the height of the column, over the points of the reference."""
    x, y = case.surface(frame(run, time), STRIP)
    places, heights = profile(data, ratio, reference)
    return tools.rms(np.interp(places, x, y, right=0) - heights)


def reach(run, ratio, time):
    """Run-out (L - L0) / L0 to where the deposit is one particle high."""
    now = frame(run, time)
    return case.farthest(*case.surface(now, STRIP), float(np.sqrt(np.mean(now["volume"])))) * ratio - 1


def judge(key, run, data, own):
    """Results of one column: the run-out between the laws of discs and of the continuum, widened; the last profile."""
    ratio, cells, what = key
    name = f"mu(I), a = {ratio}, {cells} cells over the height{what}"
    middle, half = case.band(ratio, own)
    time, compared = last(data, ratio)
    times = [time] if time > END else []
    rows = [(t, t) for t in TIMES if np.any((data["ratio"] == ratio) & (data["t"] == t))] + [(t, END) for t in times]
    judged = what == "" or "wider" in what
    source = own["profiles"][str(ratio)]
    results = [tools.Result(CASE, f"run-out (L - L0) / L0, {name}", "-", reach(run, ratio, END), *(("near", half) if judged else ("reported", None)),
                            middle, own["source"], run),
               tools.Result(CASE, f"the same to 99 % of the mass, {name}", "-", float(run.history["front"][-1]) * ratio - 1, "reported", None, None, own["source"], run)]
    for reference, at in rows:
        asked = judged and at == compared
        results.append(tools.Result(CASE, f"surface over H0, rms {'of the deposit' if reference > END else f'at {at} sqrt(H0 / g)'}, {name}", "-",
                                    difference(run, data, ratio, at, reference), *(("at most", own["surface slack"]) if asked else ("reported", None)), 0.0, source, run))
    x, y = case.surface(frame(run, compared), STRIP)
    results.append(tools.Result(CASE, f"height at the middle over H0 at the end, {name}", "-", float(y[0]), "reported", None, float(profile(data, ratio, time)[1][0]), source, run))
    return results


def draw(figure, runs, data, own):
    """Profiles of the finest run of each ratio over the reference, and run-outs over cells with the band that is asked."""
    axes = figure.subplots(2, 2)
    for axis, ratio in zip(axes.flat, COLUMNS):
        finest = max((key for key in runs if key[0] == ratio and not key[2]), key=lambda key: key[1])
        for colour, time in enumerate([t for t in (*TIMES, 99) if np.any((data["ratio"] == ratio) & (data["t"] == t))]):
            x, y = case.surface(frame(runs[finest], min(time, END)), STRIP)
            axis.plot(x, y, color=f"C{colour}", label="deposit" if time > END else f"t = {time}")
            axis.plot(*profile(data, ratio, time), "o", ms=2.5, color=f"C{colour}")
        axis.set(xlabel="x / H$_0$", ylabel="y / H$_0$", title=f"a = {ratio}, {finest[1]} cells over H$_0$", ylim=(0, None))
        axis.legend(fontsize=7)
    right = axes.flat[3]
    for colour, ratio in enumerate(COLUMNS):
        middle, half = case.band(ratio, own)
        right.axhspan(1 - half / middle, 1 + half / middle, (colour + 0.05) / 3, (colour + 0.95) / 3, color=f"C{colour}", alpha=0.15, lw=0)
        shown = [(key, reach(run, ratio, END) / middle) for key, run in runs.items() if key[0] == ratio]
        sizes = list(COLUMNS[ratio][0])
        for (_, cells, what), value in shown:
            right.plot(colour + (0.25 + 0.25 * sizes.index(cells)), value, "x" if "friction" in what else "+" if what else "o", color=f"C{colour}", fillstyle="none")
    right.set(xlim=(0, 3), title="run-out over the middle of the band", xlabel="left to right: cells smaller (+: other meshes, x: friction)")
    right.set_xticks([0.5, 1.5, 2.5], [f"a = {ratio}" for ratio in COLUMNS])
    right.xaxis.set_minor_locator(NullLocator())


def measure(lab, runs):
    """Results of the runs of a plan."""
    data, own, runs = tools.reference(CASE, "deposits.csv"), tools.reference(CASE)["mu(I)"], tools.ends(runs)
    lab.figure(CASE, "verification_mu_i_columns", lambda figure: draw(figure, runs, data, own), size=(8.6, 5.6),
               caption="Columns with the rheology mu(I): surfaces over those of a Navier-Stokes solution (a = 0.5) and of discs, and run-outs.")
    return [result for key, run in runs.items() for result in judge(key, run, data, own)]
