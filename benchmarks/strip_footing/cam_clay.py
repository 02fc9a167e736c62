"""Strip footing on saturated modified Cam clay that does not drain, beside Prandtl's load with the strength of the critical state."""
import matplotlib.tri
import numpy as np
from scipy.optimize import brentq

import lab as tools

CASE = "strip_footing"
SIZES = {1.0: "quick", 0.5: "quick", 0.25: "full"}  # m
WIDER = (0.3, 0.6)  # m, by which the clay is wider on two other meshes with cells of 0.5 m
FLOWING = 0.01  # plastic strain above which clay belongs to the mechanism
VARIANTS = {  # at full level with cells of 0.5 m: settings
    "plain volumes": {"bodies[0].f_bar": False},
    "half the speed": {"boundaries[0].velocity": [0, -0.015], "boundaries[0].table": [[0, 0], [0.4, 1]], "stages[1].duration": 3.4},
    "permeability 1e-8 m/s": {"water.flow.bodies[0].permeability": 1e-8}}


def strength(own):
    """Undrained shear strength in plane strain and mean effective stress at the critical state [Pa], of the law as the program has it.

    The volume stays: with p = p_ref (exp(e / kappa) - 1) of the elastic compression e, and pc = pc_0 exp(x / (lambda - kappa)) of the plastic one x,
    e + x is that of the start, where x = 0. At the critical state p = pc / 2 and q = sqrt(3 J2) = M p; the plastic flow of plane strain has no deviator
    out of the plane there, so that the largest shear stress is q / sqrt(3).
    """
    law, start = own["material"], own["start [Pa]"]
    elastic, plastic = law["swelling_index"], law["compression_index"] - law["swelling_index"]
    shift = law["reference_pressure"]

    def growth(p):
        return elastic * np.log((p + shift) / (start + shift)) + plastic * np.log(2 * p / law["preconsolidation_pressure"])

    p = brentq(growth, 1e-3 * start, 1e3 * start, xtol=1e-6)
    return float(law["critical_state_slope"] * p / np.sqrt(3)), float(p)


def plan(lab):
    """Runs of this level: {name: (size of cells, judged, run)}."""
    def start(name, size, **changes):
        return lab.run(f"{CASE}/cam_clay.yaml", tools.label(f"cam_clay_{name}"), {"mesh.size": size, **changes})

    runs = {f"cells of {size:g} m": (size, size == min(s for s, at in SIZES.items() if at in ("quick", lab.level)), start(f"cells of {size:g} m", size))
            for size, level in SIZES.items() if level in ("quick", lab.level)}
    if lab.level == "full":
        for wider in WIDER:
            width = 14 + wider
            name = f"cells of 0.5 m, {wider} m wider"
            runs[name] = (0.5, False, start(name, 0.5, **{"mesh.regions[0].shape.high": [width, 6], "mesh.regions[2].shape.high": [width, 7],
                                                          "bodies[0].shape.high": [width, 6]}))
        for name, changes in VARIANTS.items():
            runs[f"cells of 0.5 m, {name}"] = (0.5, False, start(name.replace(" ", "_"), 0.5, **changes))
    return runs


def curve(run, own):
    """Settlement [m] and load on half of the strip beyond that of the surface [N/m], both positive downward."""
    history = run.history
    released = history["time"][history["stage"] == 1][0] if np.any(history["stage"] == 1) else 0.0
    slow = 2 if run.folder.name.endswith("half_the_speed") else 1
    speed = own["speed [m/s]"] / slow * np.interp(history["time"], [0, 0.2 * slow], [0, 1])  # as in the scene
    speed[history["time"] < released] = 0
    settlement = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(history["time"]))])
    return settlement, -history["reaction_strip_y"]


def plateau(run, own):
    """Mean load over the last tenth of the settlement [N/m], and the slope of the load over its last quarter, as a share of the first slope."""
    settlement, load = curve(run, own)
    end, last = settlement[-1], np.mean(load[settlement > 0.9 * settlement[-1]])
    rising = (load > 0.1 * last) & (load < last / 3) & (settlement < end / 2)
    late = settlement > 0.75 * end
    return float(last), float(np.polyfit(settlement[late], load[late], 1)[0] / np.polyfit(settlement[rising], load[rising], 1)[0])


def invariants(frame):
    """Mean effective stress and q = sqrt(3 J2) of the particles [Pa]."""
    stress = frame["effective_stress"]
    p = -np.mean(stress[:, :3], axis=1)
    deviator = stress[:, :3] + p[:, None]
    return p, np.sqrt(1.5 * np.sum(deviator**2, axis=1) + 3 * np.sum(stress[:, 3:] ** 2, axis=1))


def judge(name, size, judged, run, own):
    """Results of one run."""
    undrained, critical = strength(own)
    half, capacity, source = own["half width [m]"], np.pi + 2, own["source"]
    last, slope = plateau(run, own)
    frame = run.last_frame()
    p, q = invariants(frame)
    inside = frame["plastic_strain"] > FLOWING
    grown = float(np.sum(frame["volume"]) / np.sum(run.frames[0]["volume"]) - 1)

    def report(metric, value, reference, where, criterion="reported", tolerance=None):
        return tools.Result(CASE, f"Cam clay: {metric}, {name}", "-", float(value), criterion, tolerance, reference, where, run)

    return [
        report("load over a s_u", last / (half * undrained), capacity, source, *(("within", own["slack"]) if judged else ())),
        report("load over (a + half a cell) s_u", last / ((half + size / 2) * undrained), capacity, source),
        report("slope over the last quarter over the first slope", slope, 0.0, source, *(("at most", own["slope"]) if judged else ())),
        report("median of the mean effective stress in the mechanism over that of the critical state", np.median(p[inside]) / critical, 1.0, source),
        report("q / p in the mechanism over M", np.sum(q[inside]) / np.sum(p[inside]) / own["material"]["critical_state_slope"], 1.0, source),
        report("share of the mechanism with a mean effective stress that is off by more than 5 %", np.mean(np.abs(p[inside] / critical - 1) > 0.05), 0.0, source),
        report("growth of the volume", grown, 0.0, "no water leaves"),
        report("energy that the balance leaves unexplained over the work done on the clay", abs(run.history["energy_defect"][-1] / run.history["wall_work"][-1]), 0.0, "")]


def draw(figure, runs, own):
    """Load over settlement, and plastic strain of the finest mesh."""
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.15])
    undrained, _ = strength(own)
    half = own["half width [m]"]
    for name, (_, _, run) in runs.items():
        settlement, load = curve(run, own)
        left.plot(1000 * settlement, load / (half * undrained), "--" if "," in name else "-", lw=1, label=name)
    left.axhline(np.pi + 2, color="k", lw=0.8, label="Prandtl's mechanism")
    left.axhspan(0.95 * (np.pi + 2), 1.05 * (np.pi + 2), color="k", alpha=0.08, lw=0)
    left.set(xlabel="settlement [mm]", ylabel="load / (a s$_u$)", ylim=(0, 6.8))
    left.legend(loc="lower right", fontsize=7)
    finest = min((key for key in runs if "," not in key), key=lambda key: runs[key][0])
    frame = runs[finest][2].last_frame()
    x, y = frame["position"][:, 0], frame["position"][:, 1]
    shown = right.tripcolor(matplotlib.tri.Triangulation(x, y), 100 * frame["plastic_strain"], vmin=0, vmax=4, shading="gouraud", cmap="magma_r")
    right.plot([0, half], [6.1, 6.1], "k", lw=4, solid_capstyle="butt")
    right.set(xlabel="x [m]", ylabel="y [m]", xlim=(0, 14), ylim=(0, 6.5), aspect="equal", title=finest)
    figure.colorbar(shown, label="plastic strain [%]", shrink=0.6)


def measure(lab, runs):
    """Results of the runs of a plan."""
    own = tools.reference(CASE)["cam clay"]
    runs = {name: entry for name, entry in runs.items() if not entry[2].failure()}
    lab.figure(CASE, "verification_footing_cam_clay", lambda figure: draw(figure, runs, own), size=(9.0, 3.4),
               caption="Load on a strip footing on saturated modified Cam clay over settlement (grey: 5 % about Prandtl's), and plastic strain at the end.")
    plain = {size: run for name, (size, _, run) in runs.items() if "," not in name}
    if len(plain) > 1:
        exact = (np.pi + 2) * own["half width [m]"] * strength(own)[0]
        lab.convergence(CASE, "load on Cam clay, averaged", list(plain), [abs(plateau(run, own)[0] / exact - 1) for run in plain.values()])
    return [result for name, (size, judged, run) in runs.items() for result in judge(name, size, judged, run, own)]
