"""Strip footing on undrained clay: the load under which it sinks without end, beside Prandtl's, and what locking does to it."""
import matplotlib.tri
import numpy as np

import fields
import lab as tools

CASE = "strip_footing"
SOLUTION = "Prandtl's mechanism"


def curve(run):
    """Settlement [m] and load on half of the strip [N per m of length], both positive downward."""
    history = run.history
    speed = 0.03 * np.interp(history["time"], [0, 0.2], [0, 1])  # as in the scene
    if run.folder.name.endswith("half_speed"):
        speed = 0.015 * np.interp(history["time"], [0, 0.4], [0, 1])
    settlement = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(history["time"]))])
    return settlement, np.abs(history["reaction_strip_y"])


def plateau(run):
    """Mean load over the last tenth of the settlement [N/m], and the slope of the load over its last quarter, as a share of the first slope."""
    settlement, load = curve(run)
    end, last = settlement[-1], np.mean(load[settlement > 0.9 * settlement[-1]])
    rising = (load > 0.1 * last) & (load < last / 3) & (settlement < end / 2)
    late = settlement > 0.75 * end
    return float(last), float(np.polyfit(settlement[late], load[late], 1)[0] / np.polyfit(settlement[rising], load[rising], 1)[0])


def draw(figure, runs, data):
    """Load over settlement, and the plastic strain of the first run."""
    axes = figure.subplots(1, 2, width_ratios=[1, 1.15])
    capacity, half = data["bearing capacity over strength"], data["half width [m]"]
    for name, run in runs.items():
        settlement, load = curve(run)
        axes[0].plot(1000 * settlement, load / (half * data["strength [Pa]"]), label=name)
    axes[0].axhline(capacity, color="k", lw=0.8, label=SOLUTION)
    axes[0].axhspan(0.95 * capacity, 1.05 * capacity, color="k", alpha=0.08, lw=0)
    axes[0].set(xlabel="settlement [mm]", ylabel="load / (a c)", ylim=(0, 6.5))
    axes[0].legend(loc="lower right")
    frame = next(iter(runs.values())).last_frame()
    x, y = frame["position"][:, 0], frame["position"][:, 1]
    shown = axes[1].tripcolor(matplotlib.tri.Triangulation(x, y), 100 * frame["plastic_strain"], vmin=0, vmax=4, shading="gouraud", cmap="magma_r")
    axes[1].plot([0, half], [10.1, 10.1], "k", lw=4, solid_capstyle="butt")
    axes[1].set(xlabel="x [m]", ylabel="y [m]", xlim=(0, 14), ylim=(3, 10.6), aspect="equal")
    figure.colorbar(shown, label="plastic strain [%]", shrink=0.7)


def evaluate(lab):
    """With averaging of volumes; without, a finer mesh, half the speed and the linear kernel at full level. And on modified Cam clay (cam_clay.py)."""
    data, results, cam_clay = tools.reference(CASE), [], tools.module(CASE, "cam_clay")
    saturated = cam_clay.plan(lab)
    half, strength, capacity, source = (data[key] for key in ("half width [m]", "strength [Pa]", "bearing capacity over strength", "source"))
    plan = {"averaged": ({}, 0.5, True), "averaged, projected, aflip": (tools.METHODS["projected, aflip"], 0.5, True)}
    if lab.level == "full":
        slow = {"boundaries[0].velocity": [0, -0.015], "boundaries[0].table": [[0, 0], [0.4, 1]], "stages[0].duration": 4.8}
        plan |= {"plain": ({"bodies[0].f_bar": False}, 0.5, False), "averaged, half speed": (slow, 0.5, True), "averaged, linear": ({"kernel": "linear"}, 0.5, False),
                 "averaged, cells of 0.25 m": ({"mesh.size": 0.25}, 0.25, True),
                 "plain, cells of 0.25 m": ({"mesh.size": 0.25, "bodies[0].f_bar": False}, 0.25, False)}
    labels = {name: tools.label(name) for name in plan}
    runs = {name: lab.run(f"{CASE}/scene.yaml", labels[name], settings) for name, (settings, _, _) in plan.items()}
    for name, (_, size, judged) in plan.items():
        run = runs[name]
        last, slope = plateau(run)
        asked = ("within", 0.05) if judged else ("reported", None)
        flat = ("at most", 0.01) if judged else ("reported", None)
        wider = last / ((half + size / 2) * strength)
        results += [
            tools.Result(CASE, f"load over a c, {name}", "-", last / (half * strength), *asked, capacity, source, run),
            tools.Result(CASE, f"load over (a + half a cell) c, {name}", "-", wider, "reported", None, capacity, source, run),
            tools.Result(CASE, f"slope over the last quarter over the first slope, {name}", "-", slope, *flat, 0.0, source, run),
            tools.Result(CASE, f"scatter of pressure within cells over that of cells, {name}", "-", fields.checkerboard(run.last_frame()), "reported", None, None, "", run)]
    lab.figure(CASE, "verification_footing", lambda figure: draw(figure, runs, data), size=(9.0, 3.4),
               caption="Load on a strip footing over settlement (grey: 5 % about Prandtl's), and plastic strain at the end, volumes averaged.")
    return results + cam_clay.measure(lab, saturated)
