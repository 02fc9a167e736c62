"""Cantilever in large deflection on unstructured triangles: the tip against a finite-element history."""
import numpy as np

import lab as tools

CASE = "cantilever"
SIZES = {"quick": [0.5, 0.25], "full": [0.5, 0.25, 0.125]}
SWEPT = {"quick": [1, 0.7, 0.5, 0.35], "full": [1, 0.7, 0.5, 0.35, 0.25]}  # for tradeoff()


def first_minimum(history, before=1.0):
    """Time [s] and vertical displacement [m] of the tip at its first lowest place."""
    early = history["time"] < before
    lowest = int(np.argmin(history["tip_uy"][early]))
    return float(history["time"][lowest]), float(history["tip_uy"][lowest])


def history_error(history, curve, data):
    """Root mean square of the difference to the reference history over the first minimum."""
    return tools.rms(np.interp(curve["time"], history["time"], history["tip_uy"]) - curve["uy"]) / abs(data["first minimum [m]"])


def energy_change(run, gravity):
    """Largest change of kinetic, strain and potential energy together over the largest strain energy; not taken from the program's ledger."""
    history = run.history
    potential = history["mass"] * gravity * (history["centre_y"] - history["centre_y"][0])
    return float(np.max(np.abs(history["kinetic"] + history["strain"] + potential)) / np.max(history["strain"]))


def ledger_defect(run):
    """Largest defect that the program's own energy ledger shows, over the largest strain energy."""
    return float(np.max(np.abs(run.history["energy_defect"])) / np.max(run.history["strain"]))


def draw(figure, runs, curve):
    """Deflection of the tip over time."""
    axis = figure.subplots()
    for size, run in runs.items():
        axis.plot(run.history["time"], run.history["tip_uy"], label=f"talus, cells of {size} m")
    axis.plot(curve["time"], curve["uy"], "ko", markersize=4, fillstyle="none", label="finite elements")
    axis.set(xlabel="time [s]", ylabel="vertical displacement of the tip [m]")
    axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncol=len(runs) + 1)


def judge(size, run, curve, data):
    """Results of one run; only cells of 0.25 m and smaller (8 over the height) are judged."""
    judged = size <= 0.25
    time, lowest = first_minimum(run.history)
    reference, source = data["first minimum [m]"], f"{data['source']}; {data['published']}"
    return [
        tools.Result(CASE, f"first minimum of the tip, cells of {size} m", "m", lowest, "within" if judged else "reported", 0.015 if judged else None,
                     reference, source, run),
        tools.Result(CASE, f"time of the first minimum, cells of {size} m", "s", time, "within" if judged else "reported", 0.015 if judged else None,
                     data["time of first minimum [s]"], source, run),
        tools.Result(CASE, f"rms error of the tip over 4 s, cells of {size} m", "-", history_error(run.history, curve, data), "at most" if judged else "reported",
                     0.03 if judged else None, 0.0, source, run),
        tools.Result(CASE, f"change of energy, cells of {size} m", "-", energy_change(run, data["gravity [m/s^2]"]), "at most" if judged else "reported",
                     0.005 if judged else None, 0.0, "conserved by the exact solution", run),
        tools.Result(CASE, f"defect in the program's energy ledger, cells of {size} m", "-", ledger_defect(run), "reported", None, 0.0, "energy balance", run)]


def evaluate(lab):
    """Results for the sizes of the level."""
    data, curve = tools.reference(CASE), tools.reference(CASE, "fe_history.csv")
    runs = {size: lab.run(f"{CASE}/scene.yaml", f"dx{size}", {"mesh.size": size}) for size in SIZES[lab.level]}
    lab.figure(CASE, "verification_cantilever", lambda figure: draw(figure, runs, curve), caption="Tip of the cantilever over three periods.")
    return [result for size, run in runs.items() for result in judge(size, run, curve, data)]


def tradeoff(lab):
    """Error of the tip over its first minimum and three periods, that of evaluate()."""
    data, curve = tools.reference(CASE), tools.reference(CASE, "fe_history.csv")
    return tools.Tradeoff(
        scene=f"{CASE}/scene.yaml",
        axes={"mesh": {f"cells of {size} m": {"mesh.size": size} for size in SWEPT[lab.level]},
              "particles": {f"{count} particles": {"bodies[0].particles_per_cell": count} for count in (4, 3, 6)},
              "kernel": {kernel: {"kernel": kernel} for kernel in ("umls", "linear")},
              "transfer": {scheme: {"transfer.scheme": scheme} for scheme in ("flip", "tpic")},
              "step": {f"CFL {share}": {"time.cfl": share} for share in (0.4, 0.8)}},
        error=lambda run: history_error(run.history, curve, data),
        what="rms error of the tip of the cantilever over 4 s")
