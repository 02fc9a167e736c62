"""A smooth rigid wedge that is pushed into clay, beside the slip lines of Hill, Lee and Tupper."""
import numpy as np

import lab as tools

CASE = "wedge"
# Sizes of cells [m], 7 and 14 over the depth at the end, and how much the room is higher than that of the scene [m], with which gmsh makes other triangles.
RUNS = {(0.1, 0): "quick", (0.1, 0.03): "full", (0.1, 0.07): "full", (0.05, 0): "full"}
DEPTHS = (0.35, 0.7)  # m
WIDTH = 0.03  # m of depth over which forces are averaged


def slip_line_force(depth, data):
    """Force on half of the wedge at a depth [N/m]."""
    angle = np.radians(data["half angle [degrees]"])
    low, high = 0.0, np.pi / 2  # of psi, by bisection
    for _ in range(60):
        psi = (low + high) / 2
        low, high = (low, psi) if np.cos(2 * angle - psi) > np.cos(psi) / (1 + np.sin(psi)) else (psi, high)
    pressure, length = 2 * data["strength [Pa]"] * (1 + psi), depth / (np.cos(angle) - np.sin(angle - psi))
    return pressure * length * np.sin(angle)


def depth_and_force(run):
    """Depth of the edge below the surface at the start [m], and force on half of the wedge [N/m]."""
    history = run.history
    return history["rigid_wedge_y"][0] - history["rigid_wedge_y"], history["rigid_wedge_fy"]


def judge(name, run, data):
    """Force at two depths and its growth between them."""
    depth, force = depth_and_force(run)
    results = [tools.Result(CASE, f"force over that of slip lines, {name}, depth {at} m", "-",
                            float(force[abs(depth - at) < WIDTH].mean() / slip_line_force(at, data)), "within", data["slack"], 1.0, data["source"], run)
               for at in DEPTHS]
    between = depth > DEPTHS[0]
    growth = np.polyfit(depth[between], force[between], 1)[0] / slip_line_force(1, data)
    return results + [tools.Result(CASE, f"growth of the force with depth over that of slip lines, {name}", "-", float(growth), "within",
                                   data["slack"], 1.0, data["source"], run)]


def draw(figure, runs, data):
    """Force over depth."""
    axis = figure.subplots()
    end = DEPTHS[-1]
    axis.plot([0, end], [0, slip_line_force(end, data) / 1000], "k", label="slip lines")
    for at, run in runs.items():
        depth, force = depth_and_force(run)
        axis.plot(depth, force / 1000, label=f"talus, {tools.mesh_name(*at)}")
    axis.set(xlabel="depth of the edge [m]", ylabel="force on half of the wedge [kN/m]")
    axis.legend()


def start(lab, size, higher):
    """Starts a run."""
    return lab.run(f"{CASE}/scene.yaml", tools.label(f"wedge_{size}_{higher}"), {"mesh.size": size, "mesh.regions[0].shape.high": [5, 4.5 + higher]})


def of_kernel(lab, data):
    """Starts the coarse wedge with another kernel, with what measures it."""
    at = next(iter(RUNS))
    run = start(lab, *at)
    return [(run, lambda: judge(tools.mesh_name(*at), run, data))]


def evaluate(lab):
    """Results of a wedge."""
    data = tools.reference(CASE)
    runs = {at: start(lab, *at) for at, level in RUNS.items() if level == "quick" or lab.level == "full"}
    lab.figure(CASE, "verification_wedge", lambda figure: draw(figure, runs, data), caption="Force on a wedge that is pushed into clay.")
    return [result for at, run in runs.items() for result in judge(tools.mesh_name(*at), run, data)] + tools.with_other_kernels(lab, lambda other: of_kernel(other, data))
