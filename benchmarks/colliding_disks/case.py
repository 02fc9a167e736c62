"""Two colliding elastic disks: conservation, energies and rebound against finite elements with contact."""
import numpy as np

import lab as tools
import vtp

CASE = "colliding_disks"
SCHEMES = ["flip", "tpic"]
LEAST_WINDOW = 0.03  # of the kinetic energy at the start: what finite elements and published MPM curves differ by


def momentum_drift(run, data):
    """Largest change of linear momentum over the momentum of one disk."""
    drift = [run.history[f"momentum_{axis}"] - run.history[f"momentum_{axis}"][0] for axis in "xy"]
    return float(np.max(np.hypot(*drift)) / data["momentum of one disk [kg m/s]"])


def rebound(run, data):
    """Mean velocity along the diagonal of the particles of the first disk in the last frame, over that of the approach, positive away."""
    frame = vtp.read(run.frames()[-1])
    first = frame["body"] == 0
    velocity = np.average(frame["velocity"][first, :2].sum(axis=1), weights=frame["mass"][first]) / np.sqrt(2)
    start = vtp.read(run.frames()[0])
    return float(-velocity / (np.average(start["velocity"][first, :2].sum(axis=1), weights=start["mass"][first]) / np.sqrt(2)))


def draw(figure, runs, curves, data):
    """Energies over time after contact; the runs as they are, not shifted."""
    for axis, (scheme, run) in zip(figure.subplots(1, 2, sharey=True), runs.items()):
        history = run.history
        start = history["kinetic"][0]
        for name, colour in (("kinetic", "C0"), ("strain", "C1")):
            axis.plot(history["time"], history[name] / start, color=colour, label=f"{name}, talus")
            axis.plot(curves["tau"] + data["contact [s]"], curves[name], "o", color=colour, markersize=3, fillstyle="none", label=f"{name}, finite elements")
        axis.plot(history["time"], (history["kinetic"] + history["strain"]) / start, color="0.5", label="sum, talus")
        axis.set(xlabel="time [s]", title=scheme, xlim=(0.2, 3))
    figure.axes[0].legend(fontsize=7, loc="center left")
    figure.axes[0].set_ylabel("energy / kinetic energy at the start [-]")


def judge(scheme, run, data):
    """Results of one run."""
    kinetic, strain, time = run.history["kinetic"], run.history["strain"], run.history["time"]
    least = int(np.argmin(kinetic))
    flip = scheme == "flip"
    return [
        tools.Result(CASE, f"drift of momentum over that of one disk, {scheme}", "-", momentum_drift(run, data), "at most", 1e-12, 0.0,
                     data["momentum source"], run),
        tools.Result(CASE, f"least kinetic energy over that at the start, {scheme}", "-", float(kinetic[least] / kinetic[0]), "near" if flip else "reported",
                     LEAST_WINDOW if flip else None, data["least kinetic energy"], data["source"], run),
        tools.Result(CASE, f"time of least kinetic energy, {scheme}", "s", float(time[least]), "reported", None, data["contact [s]"] + 0.517,
                     data["source"], run),
        tools.Result(CASE, f"rebound speed over approach speed, {scheme}", "-", rebound(run, data), "reported", None, data["rebound"], data["source"], run),
        tools.Result(CASE, f"energy at the end over that at the start, {scheme}", "-", float((kinetic[-1] + strain[-1]) / kinetic[0]),
                     "at least" if flip else "reported", 0.95 if flip else None, 1.0, "conserved by the exact solution", run)]


def evaluate(lab):
    """Results with two transfers: increments (flip) keep the energy, the affine one (tpic) spends some in the collision."""
    data, curves = tools.reference(CASE), tools.reference(CASE, "fe_curves.csv")
    runs = {scheme: lab.run(f"{CASE}/scene.yaml", scheme, {"transfer.scheme": scheme}) for scheme in SCHEMES}
    lab.figure(CASE, "verification_disks", lambda figure: draw(figure, runs, curves, data), size=(7.6, 3.4),
               caption="Energies of the colliding disks. Without a contact law bodies feel each other when their nodes do, about a cell early.")
    return [result for scheme, run in runs.items() for result in judge(scheme, run, data)]
