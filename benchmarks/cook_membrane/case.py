"""Cook's membrane: lift of the corner towards incompressibility, with and without averaging of volumes over the stars of nodes."""
import numpy as np

import fields
import lab as tools

CASE = "cook_membrane"


def lift(run, corner):
    """Upward displacement of a corner of the body [m]: no particle sits there, so a plane through the twelve nearest ones is extended."""
    frame = run.last_frame()
    start = frame["position"][:, :2] - frame["displacement"][:, :2]
    return float(fields.extended(start, frame["displacement"][:, 1], corner))


def draw(figure, runs):
    """Pressure of the particles of two runs."""
    for axis, (name, run) in zip(figure.subplots(1, len(runs), sharey=True, squeeze=False).flat, runs.items()):
        frame = run.last_frame()
        dots = axis.scatter(frame["position"][:, 0], frame["position"][:, 1], c=frame["pressure"], s=4, vmin=-0.2, vmax=0.2, cmap="viridis")
        axis.set(title=name, aspect="equal", xlabel="x [m]")
    figure.colorbar(dots, label="pressure [Pa]")


def evaluate(lab):
    """Four Poisson's ratios, the averaging on and off, another method beside that of the scene; at full level finer cells and what is nearer to 0.5: their steps are many."""
    data, results, pictured = tools.reference(CASE), [], {}
    corner = np.array(data["corner"], dtype=float)
    plan = [("0.3", 4, False), ("0.3", 2, True), ("0.499", 4, False), ("0.499", 4, True)]
    beside = [("0.3", 4, False)] if lab.level == "quick" else plan[:]
    if lab.level == "full":
        plan += [("0.499", 2, True), ("0.499", 2, False), ("0.499", 1, True), ("0.4999", 4, True), ("0.49999", 4, True)]
    asked = {("0.499", 2, True): 0.02, ("0.499", 1, True): 0.02, ("0.49999", 4, True): 0.05}
    runs = []
    for nu, size, averaged, other in [*((*choice, "") for choice in plan), *((*choice, "projected, aflip") for choice in beside)]:
        name = f"nu {nu}, cells of {size} m, {'averaged' if averaged else 'plain'}{', ' + other if other else ''}"
        runs.append((nu, size, averaged, other, name, lab.run(f"{CASE}/scene.yaml", tools.label(name), {
            "materials[0].poisson_ratio": float(nu), "mesh.size": size, "bodies[0].f_bar": averaged, **tools.METHODS.get(other, {})})))
    for nu, size, averaged, other, name, run in runs:
        if run.failure():
            continue
        tolerance = asked.get((nu, size, averaged))
        results.append(tools.Result(CASE, f"lift of the corner, {name}", "m", lift(run, corner), "within" if tolerance else "reported", tolerance,
                                    data["lift [m]"][nu], data["source"], run))
        results.append(tools.Result(CASE, f"scatter of pressure within cells over that of cells, {name}", "-", fields.checkerboard(run.last_frame()), "reported", None, None, "", run))
        if (nu, size, other) == ("0.499", 4, ""):
            pictured["averaged" if averaged else "plain"] = run
    lab.figure(CASE, "verification_cook", lambda figure: draw(figure, pictured), size=(7.4, 3.4),
               caption="Pressure in Cook's membrane at Poisson's ratio 0.499 without and with averaging of volumes.")
    return results
