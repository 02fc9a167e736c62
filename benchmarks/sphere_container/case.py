"""A rubber ball that expands inside a closed spherical wall of the mesh: nothing leaves, where the contact begins, what it costs."""
import numpy as np

import lab as tools

CASE = "sphere_container"
SIZES = {"quick": [0.2, 0.13], "full": [0.2, 0.13, 0.09]}  # m


def extent(run):
    """Times of the frames [s], radius of the outermost particle [m] and volume of the body [m^3] in them."""
    frames = list(run.frames)
    times = np.linspace(0, run.history["time"][-1], len(frames))
    return times, np.array([np.linalg.norm(frame["position"], axis=1).max() for frame in frames]), np.array([frame["volume"].sum() for frame in frames])


def mass_lost(run):
    """Mass of the particles that left over the mass."""
    mass = run.summary["balances"]["mass"]
    return mass["removed [kg]"] / mass["start [kg]"]


def energy(run):
    """Kinetic and strain energy over the kinetic energy at the start."""
    return (run.history["kinetic"] + run.history["strain"]) / run.history["kinetic"][0]


def drift(run):
    """How far the centre of mass moves, which stays where it is in a round wall [m]."""
    return float(np.max(np.sqrt(sum((run.history[f"centre_{axis}"] - run.history[f"centre_{axis}"][0])**2 for axis in "xyz"))))


def draw(figure, runs, data):
    """Radius of the outermost particle and energy over time."""
    left, right = figure.subplots(1, 2)
    for name, run in runs.items():
        times, radius, _ = extent(run)
        left.plot(times, radius, label=name)
        right.plot(run.history["time"], energy(run), label=name)
    left.axhline(data["radius of the container [m]"], color="k", label="wall")
    left.set(xlabel="time [s]", ylabel="radius of the outermost particle [m]")
    right.set(xlabel="time [s]", ylabel="energy / that at the start [-]", ylim=(0, 1.05))
    left.legend(fontsize=7)


def judge(name, size, run, data):
    """Results of one run."""
    wall = data["radius of the container [m]"]
    _, radius, volume = extent(run)

    def result(metric, unit, value, reference, words, criterion="reported", tolerance=None):
        return tools.Result(CASE, f"{metric}, {name}", unit, value, criterion, tolerance, reference, words, run)

    return [
        result("mass lost", "-", mass_lost(run), 0.0, data["source"], "at most", 0.0),
        result("radius of the outermost particle ever", "m", float(radius.max()), wall, data["source"], "at most", wall),
        result("gap between wall and outermost particle at the largest extent, over the cell size", "-", float((wall - radius.max()) / size), None, ""),
        result("largest volume of the body over that of the container", "-", float(volume.max() / (4 / 3 * np.pi * wall**3)), 1.0, data["source"], "at most", 1.0),
        result("energy at the end over that at the start", "-", float(energy(run)[-1]), 1.0, data["energy source"]),
        result("way of the centre of mass", "m", drift(run), 0.0, "symmetry")]


def evaluate(lab):
    """Two or three meshes; friction, which cannot matter because all motion is along the normal, and the affine transfer on the coarsest."""
    data, coarse = tools.reference(CASE), SIZES[lab.level][0]
    runs = {f"cells of {size} m": (size, lab.run(f"{CASE}/scene.yaml", f"dx{size}", {"mesh.size": size})) for size in SIZES[lab.level]}
    runs |= {f"cells of {coarse} m, friction 0.5": (coarse, lab.run(f"{CASE}/scene.yaml", "friction", {"mesh.size": coarse, "boundaries[0].coefficient": 0.5})),
             f"cells of {coarse} m, tpic": (coarse, lab.run(f"{CASE}/scene.yaml", "tpic", {"mesh.size": coarse, "transfer.scheme": "tpic"}))}
    lab.figure(CASE, "verification_container", lambda figure: draw(figure, {name: run for name, (_, run) in runs.items()}, data), size=(7.6, 3),
               caption="Ball that expands in a spherical container: its outermost particle and its energy.")
    plain = [(size, run) for size, run in runs.values() if run.label.startswith("dx")]
    lab.convergence(CASE, "gap left between wall and outermost particle [m]", [size for size, _ in plain],
                    [data["radius of the container [m]"] - extent(run)[1].max() for _, run in plain], expected=1)
    return [result for name, (size, run) in runs.items() for result in judge(name, size, run, data)]
