"""Patch tests: scatter of a uniform stress at rest, and of a uniform velocity gradient, on irregular meshes."""
import numpy as np

import lab as tools

CASE = "patch_test"
KERNELS = {"linear": "flip", "umls": "flip", "projected": "aflip"}
STRETCHED = {"linear": "tpic", "umls": "tpic", "projected": "aflip"}
GRID = "{grid: {low: [0, 0], high: [1, 1], cells: [10, 10], jitter: %g}}"
MESHES = {  # name: mesh, None for that of the scene; the body fills all of it
    "regular": GRID % 0, "jittered 20 %": GRID % 0.2, "gmsh": None}
PRESSED = 3e5  # Pa, on a modulus of 1 MPa
BODY = "{name: square, material: rubber, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: %d}"
START = np.array([[1, 0.5], [0.25, -1]])  # 1/s, gradient of scene_stretch.yaml


def patch(lab, mesh, kernel, count):
    """Starts a static patch test with `count` particles per cell."""
    settings = {"bodies[0].particles_per_cell": count} if mesh == "gmsh" else {"mesh": MESHES[mesh], "bodies[0]": BODY % count}
    return lab.run(f"{CASE}/scene.yaml", f"{mesh.replace(' ', '_').replace('%', 'percent')}_{kernel}_{count}", {**settings, "kernel": kernel, "transfer.scheme": KERNELS[kernel]})


def exact_patch(lab, kernel):
    """Starts the patch test on a coarse jittered mesh until it is at rest to rounding, which leaves 1e-16 over the strain of 7e-6 of the loads."""
    points = [{"name": f"p{i}{j}", "at": [i / 5, j / 5]} for i in range(1, 5) for j in range(1, 5)]
    return lab.run(f"{CASE}/scene.yaml", f"to_rounding_{kernel}", {
        "mesh": GRID.replace("10, 10", "5, 5") % 0.2, "bodies[0]": BODY % 6, "stages[0].residual": 1e-10, "stages[0].duration": 8, "outputs.history.points": points,
        "kernel": kernel, "transfer.scheme": KERNELS[kernel]})


def pressed(lab, kernel):
    """Starts the patch test pressed by a third of the modulus: particles come to lie anywhere in their cells, the load goes with the surface."""
    end = {"name": "end", "of": "square:boundary", "within": {"low": [0.99, -0.01], "high": [1.01, 1.01]}}
    return lab.run(f"{CASE}/scene.yaml", f"pressed_{kernel}", {
        "mesh.groups": [end], "loads": [{"type": "traction", "on": "end", "traction": [-PRESSED, 0]}], "bodies[0].particles_per_cell": 9,
        "stages[0].residual": 1e-3, "stages[0].duration": 3, "kernel": kernel, "transfer.scheme": KERNELS[kernel]})


def strain_error(run, data):
    """Largest error of the strain at sixteen particles: that of the stress along x over the modulus; the history has all digits.

    With a strain of 7e-6 its square, 5e-11, is left: mesh and load stay where they are while the square shrinks.
    """
    stress = np.array([run.history[f"p{i}{j}_sxx"][-1] for i in range(1, 5) for j in range(1, 5)])
    return float(np.max(np.abs(stress + data["pressure [Pa]"])) / data["modulus [Pa]"])


def pressed_error(run, share=1):
    """Root of the mean over the mass of the square of the error in the stress along x over its exact value, the load, in that share of the length that is farthest from it."""
    frame = run.last_frame()
    part = frame["position"][:, 0] <= share * frame["position"][:, 0].max()
    return float(np.sqrt(np.average((frame["stress"][part, 0] / -PRESSED - 1)**2, weights=frame["mass"][part])))


def stress_error(run, data):
    """Root of the mean over the mass of the square of the error in the stress (xx, yy, xy) over the pressure, and the largest error."""
    frame, pressure, nu = run.last_frame(), data["pressure [Pa]"], data["Poisson's ratio"]
    wrong = frame["stress"][:, [0, 1, 3]] - np.array([-pressure, -pressure * nu / (1 - nu), 0])
    size = np.linalg.norm(wrong, axis=1) / pressure
    return float(np.sqrt(np.average(size**2, weights=frame["mass"]))), float(size.max())


def gradient_error(run, index):
    """Root mean square, over particles that start 0.15 m and more inside, of the error in the velocity gradient over its exact value, in one file."""
    time, frame = run.frames.times[index], run.frames[index]
    place = frame["position"] - frame["displacement"]
    inside = np.all(np.abs(place[:, :2] - 0.5) < 0.15, axis=1)
    exact = START @ np.linalg.inv(np.eye(2) + time * START)
    wrong = frame["velocity_gradient"].reshape(-1, 3, 3)[inside, :2, :2] - exact
    return float(np.sqrt(np.mean(np.sum(wrong**2, axis=(1, 2)))) / np.linalg.norm(exact))


def evaluate(lab):
    """Static patch tests on three meshes and uniform stretching, each with three kernels; to the last digit, and strongly pressed with `projected`."""
    data, results = tools.reference(CASE), []
    counts = [6] if lab.level == "quick" else [3, 6, 12]
    runs = {(mesh, kernel, count): patch(lab, mesh, kernel, count) for mesh in MESHES for kernel in KERNELS for count in counts}
    rounded = {kernel: exact_patch(lab, kernel) for kernel in ("linear", "projected")}
    squeezed = {kernel: pressed(lab, kernel) for kernel in ("umls", "projected")}  # with linear it never comes to rest
    stretched = {kernel: lab.run(f"{CASE}/scene_stretch.yaml", f"stretch_{kernel}", {"kernel": kernel, "transfer.scheme": STRETCHED[kernel]}) for kernel in KERNELS}
    runs = tools.ends(runs)
    for (mesh, kernel, count), run in runs.items():
        mean, largest = stress_error(run, data)
        name, judged = f"{mesh}, {kernel}, {count} particles per cell", kernel != "umls"
        results.append(tools.Result(CASE, f"stress error over the pressure, rms, {name}", "-", mean, "at most" if judged else "reported",
                                    data["largest error"] if judged else None, 0.0, data["source"], run))
        results.append(tools.Result(CASE, f"the largest, {name}", "-", largest, "reported", None, 0.0, data["source"], run))
    for kernel, run in stretched.items():
        for when, index in (("after 0.01 s", 1), ("after 0.1 s", -1)):
            results.append(tools.Result(CASE, f"error of a uniform velocity gradient {when}, {kernel}, {STRETCHED[kernel]}", "-", gradient_error(run, index), "reported", None,
                                        0.0, data["stretch source"], run))
    for kernel, run in tools.ends(rounded).items():
        results.append(tools.Result(CASE, f"largest error of the strain, at rest to rounding, jittered 20 %, {kernel}", "-", strain_error(run, data), "at most",
                                    data["largest error of the strain"], 0.0, data["source"], run))
    for kernel, run in tools.ends(squeezed).items():
        asked = kernel == "projected"
        results.append(tools.Result(CASE, f"stress error over the load, rms, pressed by a third of the modulus, 9 particles per cell, {kernel}", "-",
                                    pressed_error(run), "at most" if asked else "reported", data["largest error, pressed"] if asked else None, 0.0,
                                    data["pressed source"], run))
        results.append(tools.Result(CASE, f"the same, without the third next to the load, {kernel}", "-", pressed_error(run, 2 / 3), "reported", None, 0.0,
                                    data["pressed source"], run))
    lab.figure(CASE, "verification_patch", lambda figure: tools.draw_pressing_stress(figure, {kernel: run for (mesh, kernel, count), run in runs.items() if (mesh, count) == ("jittered 20 %", 6)}, data),
               size=(9.6, 3.2), caption="Static patch test on a jittered mesh: stress of the particles over the uniform exact one.")
    return results
