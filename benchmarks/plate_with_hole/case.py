"""Strip with a hole: stress at the hole against Howland's solution, three kernels, triangles that follow the hole."""
import numpy as np

import lab as tools

CASE = "plate_with_hole"
PARTS = {"quick": [4, 8], "full": [4, 8, 16]}  # cells over the radius
JUDGED = 8  # cells over the radius, those of the published run; coarser ones are reported
FINE = {"quick": {"projected": 4}, "full": {}}  # cells over the radius at most: projected comes to rest there only after two minutes of processor time
KERNELS = {"umls": "tpic", "linear": "tpic", "projected": "aflip"}  # each with its transfer; a plate at rest crosses no cell
EXACT = 4  # cells over the radius with forces by exact slopes as well
REACH = 2  # radii from the centre: where stress is read from


def shapes(radius, angle):
    """Functions of which Kirsch's solution for the infinite plate is a sum; `radius` over that of the hole, `angle` [rad] from the direction of the pull."""
    return np.stack([r * a for r in (1 + 0 * radius, radius**-2.0, radius**-4.0) for a in (1 + 0 * angle, np.cos(2 * angle), np.cos(4 * angle))], -1)


def hole(run, data):
    """Stress at A (side of the hole, along the pull) and at B (its end, across), over the traction, and the scatter of particles about the fit.

    No particle sits on the hole: `shapes` are fitted by least squares to the particles around it and taken on the hole.
    """
    frame = run.last_frame()
    x, y = frame["position"][:, 0], frame["position"][:, 1]
    radius, angle = np.hypot(x, y) / data["radius [m]"], np.arctan2(y, x)
    near = radius < REACH
    stress = frame["stress"][near, :2] / data["traction [Pa]"]
    fitted = np.linalg.lstsq(shapes(radius[near], angle[near]), stress, rcond=None)[0]
    at_a, at_b = shapes(np.ones(2), np.array([np.pi / 2, 0])) @ fitted
    return float(at_a[0]), float(at_b[1]), tools.rms(shapes(radius[near], angle[near]) @ fitted - stress)


def end_force(run):
    """Force of the plane of symmetry over that of the traction: 1 at rest."""
    return float(run.history["reaction_x_min_x"][-1] / -(2.0e7 * 0.5))


def draw(figure, runs, data):
    """Left the stress along the pull of all particles near the hole, right that near the section through A over y."""
    left, right = figure.subplots(1, 2, width_ratios=[1.2, 1])
    for kernel, run in runs.items():
        frame = run.last_frame()
        x, y = frame["position"][:, 0] / data["radius [m]"], frame["position"][:, 1] / data["radius [m]"]
        stress = frame["stress"][:, 0] / data["traction [Pa]"]
        if kernel == "umls":
            dots = left.scatter(x, y, c=stress, s=5, vmin=0, vmax=3.2, cmap="viridis")
        section = np.degrees(np.arctan2(x, y)) < 6
        right.plot(y[section], stress[section], ".", label=f"talus, {kernel}")
    far = np.linspace(1, 5, 200)
    right.plot(far, 1 + 0.5 / far**2 + 1.5 / far**4, "0.6", label="Kirsch, infinite plate")
    right.plot(1, data["A"], "k*", label="Howland")
    left.set(xlim=(0, 3), ylim=(0, 3), aspect="equal", xlabel="x / R", ylabel="y / R", title="umls")
    right.set(xlabel="y / R", ylabel="stress along the pull / traction [-]")
    right.legend(fontsize=7)
    figure.colorbar(dots, ax=left)


def judge(kernel, parts, run, data):
    """Results of one run."""
    name, source, judged = f"{kernel}, cells of R/{parts}", f"{data['source']}; {data['published']}", parts >= JUDGED
    at_a, at_b, scatter = hole(run, data)

    def result(metric, value, reference, words, criterion="reported", tolerance=None):
        return tools.Result(CASE, f"{metric}, {name}", "-", value, criterion, tolerance, reference, words, run)

    asked = ("within", data["slack"]) if judged else ()
    return [result("stress along the pull at A over the traction", at_a, data["A"], source, *asked),
            result("stress across the pull at B over the traction", at_b, data["B"], source, *asked),
            result("scatter of the stress within 2 R about the smooth field", scatter, 0.0, source),
            result("force of the symmetry plane over that of the traction", end_force(run), 1.0, "equilibrium")]


def evaluate(lab):
    """Results of three kernels on two or three meshes."""
    data = tools.reference(CASE)
    runs = {(kernel, parts): lab.run(f"{CASE}/scene.yaml", f"{kernel}_{parts}",
                                     {"kernel": kernel, "transfer.scheme": KERNELS[kernel], "mesh.size": 0.8 / parts, "mesh.refine[0].size": data["radius [m]"] / parts})
            for parts in PARTS[lab.level] for kernel in KERNELS if parts <= FINE[lab.level].get(kernel, parts)}
    runs["umls, exact_force", EXACT] = lab.run(f"{CASE}/scene.yaml", f"exact_force_{EXACT}", {
        **tools.METHODS["umls, exact_force, aflip"], "mesh.size": 0.8 / EXACT, "mesh.refine[0].size": data["radius [m]"] / EXACT})
    runs = tools.ends(runs)
    for kernel in KERNELS:
        found = {data["radius [m]"] / parts: hole(run, data) for (method, parts), run in runs.items() if method == kernel}
        if len(found) > 1:
            lab.convergence(CASE, f"relative error at A, {kernel}", list(found), [abs(at_a / data["A"] - 1) for at_a, _, _ in found.values()])
            lab.convergence(CASE, f"scatter about the smooth field, {kernel}", list(found), [scatter for _, _, scatter in found.values()])
    lab.figure(CASE, "verification_hole", lambda figure: draw(figure, {kernel: run for (kernel, parts), run in runs.items() if parts == JUDGED}, data), size=(7.6, 3.2),
               caption="Strip with a hole: stress in the direction of the load around the hole, and over the section through its side, cells of R/8.")
    return [result for (kernel, parts), run in runs.items() for result in judge(kernel, parts, run, data)]
