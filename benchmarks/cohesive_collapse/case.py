"""Collapse of a cohesive block under growing weight: load at which it begins, against limit analysis, and what is left at the end."""
import numpy as np

import lab as tools

CASE = "cohesive_collapse"
FULL_WEIGHT = 10.0  # kN/m^3, at the end
ELASTIC = 2.0  # kN/m^3, up to which the block is taken as elastic
FACTOR = 10  # collapse: the edge of the crest sinks this many times faster with load than while elastic
FIXED, SMOOTH = {}, {"boundaries[0]": "{type: roller, on: y_min}"}
SLOW = {"loads[0].table": [[0, 0], [160, 1]], "stages[0].duration": 160, "outputs.history.every": 4}
LINEAR = {"kernel": "linear", "transfer.scheme": "flip"}  # with tpic the law is given no finite strain when the collapse begins
# name, size of cells [m], averaging of volumes, settings
QUICK = [("umls", 0.5, True, FIXED), ("umls", 1, True, FIXED), ("umls", 1, False, FIXED), ("linear", 1, True, LINEAR), ("linear", 1, False, LINEAR),
         ("umls, smooth base", 1, True, SMOOTH)]
FULL = [("umls", 0.25, True, FIXED), ("umls", 0.5, False, FIXED), ("linear", 0.5, True, LINEAR), ("linear", 0.5, False, LINEAR),
        ("umls, smooth base", 0.5, True, SMOOTH), ("umls, twice as slow", 0.5, True, SLOW)]


def weight(run):
    """Unit weight [kN/m^3] at the rows of the history."""
    time = run.history["time"]
    return FULL_WEIGHT * time / time[-1]


def settlement(run, point="edge"):
    """Settlement of a point of the crest [m] at the rows of the history."""
    return -run.history[f"{point}_uy"]


def spread(run):
    """Advance of the farthest particle [m] at the rows of the history."""
    return run.history["front"] - run.history["front"][0]


def onset(run):
    """Unit weight [kN/m^3] at which the edge of the crest first sinks FACTOR times faster with load than while elastic."""
    load, sunk = weight(run), settlement(run)
    elastic = np.polyfit(load[load <= ELASTIC], sunk[load <= ELASTIC], 1)[0]
    rate, middle = np.diff(sunk) / np.diff(load) / elastic, (load[1:] + load[:-1]) / 2
    first = int(np.argmax(rate > FACTOR))
    return float(np.interp(FACTOR, rate[first - 1:first + 1], middle[first - 1:first + 1])) if rate[first] > FACTOR else float("nan")


def judge(name, run, data, judged):
    """Results of one run; `judged` says whether the onset has a verdict."""
    cohesion = data["yield stress [Pa]"] / np.sqrt(3)
    critical = data["stability number"] * cohesion / data["height [m]"] / 1000
    verdict = ("within", data["scatter"]) if judged else ("reported", None)
    results = [tools.Result(CASE, f"weight at which collapse begins, {name}", "kN/m^3", onset(run), *verdict, critical,
                            data["stability source"], run)]
    for load in (5, 10):
        at = int(np.argmin(np.abs(weight(run) - load)))
        for what, values in (("settlement of the edge of the crest", settlement(run)), ("advance of the front", spread(run))):
            results.append(tools.Result(CASE, f"{what} at {load} kN/m^3, {name}", "m", float(values[at]), "reported", None, None,
                                        data["published source"], run))
    return results


def draw(figure, runs, pictured, critical):
    """Settlement over weight, and the particles of one run at the end by plastic strain."""
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.3])
    for name, run in runs.items():
        left.plot(weight(run), settlement(run), "--" if "plain" in name else "-", lw=1, label=name)
    left.axvline(critical, color="k", lw=0.8, ls=":", label="limit analysis")
    left.set(xlabel="unit weight [kN/m$^3$]", ylabel="settlement of the edge of the crest [m]", xlim=(0, 10), ylim=(0, 4))
    left.legend(fontsize=6, loc="upper left")
    frame = pictured.last_frame()
    dots = right.scatter(frame["position"][:, 0], frame["position"][:, 1], c=frame["plastic_strain"], s=3, vmin=0, vmax=2, cmap="viridis")
    right.plot([0, 8, 8], [8, 8, 0], color="0.6", lw=0.8)
    right.set(aspect="equal", xlim=(0, 16), ylim=(0, 8.5), xlabel="x [m]", title="at 10 kN/m$^3$")
    figure.colorbar(dots, label="plastic strain", shrink=0.7)


def evaluate(lab):
    """Two kernels, two meshes, with and without averaging of volumes; the default settings with cells of 0.5 m and less are judged."""
    data, runs, judged = tools.reference(CASE), {}, set()
    for kind, size, averaged, changes in QUICK + (FULL if lab.level == "full" else []):
        name = f"{kind}, cells of {size} m, {'averaged' if averaged else 'plain'}"
        label = tools.label(name)
        runs[name] = lab.run(f"{CASE}/scene.yaml", label, {"mesh.size": size, "bodies[0].f_bar": averaged, **changes})
        if kind == "umls" and averaged and size <= 0.5:
            judged.add(name)
    results = [result for name, run in runs.items() for result in judge(name, run, data, name in judged)]
    critical = results[0].reference
    lab.figure(CASE, "verification_block_of_clay", lambda figure: draw(figure, runs, next(iter(runs.values())), critical), size=(8.4, 3.2),
               caption="Collapse of a cohesive block: settlement over unit weight, and plastic strain at the end.")
    return results
