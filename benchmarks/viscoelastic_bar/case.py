"""A viscoelastic bar that swings in its first axial mode, beside the solution for small strains."""
import numpy as np

import lab as tools

CASE = "viscoelastic_bar"
SIZES = {0.5: "quick", 0.25: "quick", 0.125: "full"}  # m: 2, 4 and 8 cells over the height, 50 to 200 over the length
ENDS = {30: "quick", 30.3: "full", 30.6: "full"}  # m: gmsh then makes other triangles


def exact(time, data):
    """Displacement of the free end [m] at each time."""
    wave = np.pi / 2 / data["length [m]"]
    shares, times = np.array(data["shares"]), np.array(data["times [s]"])
    shear = 4 / 3 * data["shear modulus [Pa]"]
    stiffness = wave**2 / data["density [kg/m^3]"]
    system = np.zeros((2 + len(shares),) * 2)  # of displacement, velocity and elastic parts
    system[0, 1] = 1
    system[1, 0] = -stiffness * (data["bulk modulus [Pa]"] + shear * (1 - shares.sum()))
    for i, (share, relaxation) in enumerate(zip(shares, times)):
        system[1, 2 + i], system[2 + i, 1], system[2 + i, 2 + i] = -stiffness * shear * share, 1, -1 / relaxation
    values, vectors = np.linalg.eig(system)
    start = np.zeros(len(system))
    start[1] = data["velocity of the tip at the start [m/s]"]
    weights = np.linalg.solve(vectors, start)
    return (vectors[0] * weights @ np.exp(np.outer(values, time))).real


def error(run, data):
    """Root of the mean square difference of the displacement of the tip, over its largest value."""
    history = run.history
    reference = exact(history["time"], data)
    return float(tools.rms(history["tip_ux"] - reference) / np.abs(reference).max())


def judge(size, end, run, data):
    """Difference to the solution for small strains."""
    return tools.Result(CASE, f"difference of the displacement of the tip over its largest value, cells of {size} m, channel of {end} m", "-",
                        error(run, data), "at most", data["slack"], 0.0, data["source"], run)


def draw(figure, runs, data):
    """Displacement of the tip."""
    axis = figure.subplots()
    time = np.linspace(0, 40, 400)
    axis.plot(time, exact(time, data), "k", label="solution for small strains")
    for size in SIZES:
        if (size, 30) in runs:
            history = runs[size, 30].history
            axis.plot(history["time"], history["tip_ux"], "--", label=f"talus, cells of {size} m")
    axis.set(xlabel="time [s]", ylabel="displacement of the tip [m]")
    axis.legend()


def evaluate(lab):
    """Results of a viscoelastic bar."""
    data = tools.reference(CASE)
    runs = {(size, end): lab.run(f"{CASE}/scene.yaml", tools.label(f"{size}_{end}"), {"mesh.size": size, "mesh.regions[0].shape.high": [end, 1]})
            for size in SIZES for end in ENDS if lab.level == "full" or {SIZES[size], ENDS[end]} == {"quick"}}
    results = [judge(size, end, run, data) for (size, end), run in runs.items()]
    lab.figure(CASE, "verification_viscoelastic_bar", lambda figure: draw(figure, runs, data), caption="Free end of a viscoelastic bar.")
    sizes = [size for size in SIZES if (size, 30) in runs]
    lab.convergence(CASE, "difference of the tip over its largest displacement", sizes, [error(runs[size, 30], data) for size in sizes])
    return results
