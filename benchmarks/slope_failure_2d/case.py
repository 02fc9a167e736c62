"""Failure of a clayey slope: final surface and toe against a published numerical solution, and what the ledgers say."""
import numpy as np

import lab as tools

CASE = "slope_failure_2d"
SIZE = {"quick": 1.5, "full": 1.0}  # m, cells
SOFTENING = {"materials[0].residual_friction_angle": 7.5, "materials[0].residual_cohesion": 4.0e3, "materials[0].softening_strain": 0.1}
DEFAULT = tools.METHODS["projected, aflip"]
VARIANTS = {  # name: changes to the scene, whether place and surface are judged, level
    "peak": ({}, True, "quick"), "peak, projected, aflip": (DEFAULT, True, "quick"),
    "softening": (SOFTENING, False, "full"), "softening, projected, aflip": ({**SOFTENING, **DEFAULT}, False, "quick"),
    "peak, projected, aflip, cells of 1.5 m": ({**DEFAULT, "mesh.size": SIZE["quick"]}, True, "full")}
SCORED = (15.0, 60.0)  # m, where the surface is compared
LEVEL_GROUND = 15.0  # m, in front of the slope


def surface(frame, spacing, width=2.0):
    """Free surface as (x, y): the highest particle of each strip of `width`, raised by half the distance `spacing` of particles [m]."""
    x, y = frame["position"][:, 0], frame["position"][:, 1]
    strip = (x / width).astype(int)
    highest = np.full(strip.max() + 1, -np.inf)
    np.maximum.at(highest, strip, y)
    filled = np.isfinite(highest)
    return (np.arange(len(highest))[filled] + 0.5) * width, highest[filled] + spacing / 2


def toe(frame, spacing):
    """Farthest x [m] of soil that lies clearly, by a spacing of particles, above the level ground and came down from the slope."""
    start = frame["position"] - frame["displacement"]
    debris = (frame["position"][:, 1] > LEVEL_GROUND + spacing) & (start[:, 0] < 50) & (start[:, 1] > LEVEL_GROUND)
    return float(np.max(frame["position"][debris, 0]) + spacing / 2)


def spacing(run):
    """Mean distance of particles at the start [m]: root of the mean area, or cube root of the mean volume, per particle."""
    frame = run.frames[0]
    return float(np.mean(frame["volume"]) ** (1 / run.summary["dimension"]))


def surface_error(run, data):
    """Root mean square [m] of the difference of the surfaces at the points of the reference within SCORED."""
    x, y = surface(run.last_frame(), spacing(run))
    inside = (data["x"] >= SCORED[0]) & (data["x"] <= SCORED[1])
    return tools.rms(np.interp(data["x"][inside], x, y) - data["y"][inside])


def energy_defect(run):
    """Defect of the energy balance over the dissipated energy of the stage in which the slope fails."""
    stage = run.history["stage"] == run.history["stage"][-1]
    gained = {name: run.history[name][stage][-1] - run.history[name][stage][0] for name in ("energy_defect", "plastic", "transfer_loss", "friction")}
    return float(abs(gained["energy_defect"]) / (gained["plastic"] + gained["friction"] + abs(gained["transfer_loss"])))


def mass_error(run):
    """Largest change of mass, relative."""
    mass = run.history["mass"]
    return float(np.max(np.abs(mass / mass[0] - 1)))


def judge(name, run, data, info, size):
    """Results of one run; its place is judged by the size of cells [m] where `size` is given."""
    where = f"{info['source']} ({info['nature']})"
    shape, front = ("at most", "near") if size else ("reported", "reported")
    return [
        tools.Result(CASE, f"final surface, rms over 15 < x < 60 m, {name}", "m", surface_error(run, data), shape, size, 0.0, where, run),
        tools.Result(CASE, f"toe of the debris, {name}", "m", toe(run.last_frame(), spacing(run)), front, 2 * size if size else None,
                     info["toe x [m]"], where, run),
        tools.Result(CASE, f"height lost by the crest, {name}", "m", float(-run.history["crest_uy"][-1]), "reported", None, None, "", run),
        tools.Result(CASE, f"energy defect over dissipated energy, {name}", "-", energy_defect(run), "at most", 0.01, 0.0, "energy balance", run),
        tools.Result(CASE, f"change of mass, {name}", "-", mass_error(run), "at most", 1e-12, 0.0, "mass balance", run)]


def draw(figure, runs, data):
    """Final surfaces over the reference and the first shape."""
    axis = figure.subplots()
    axis.plot([0, 30, 50, 110], [35, 35, 15, 15], color="0.7", label="before")
    for name, run in runs.items():
        axis.plot(*surface(run.last_frame(), spacing(run)), label=f"talus, {name}")
    axis.plot(data["x"], data["y"], "k.", label="Huang et al. 2015 (numerical)")
    axis.set(xlim=(0, 85), ylim=(10, 37), xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axis.legend()


def evaluate(lab):
    """Results with the peak strength alone and with softening, with two kernels; at the full level also for a slice of tetrahedra with peak strength."""
    info, data = tools.reference(CASE), tools.reference(CASE, "surface.csv")
    sizes = {name: changes.get("mesh.size", SIZE[lab.level]) for name, (changes, _, level) in VARIANTS.items() if level in ("quick", lab.level)}
    runs = {name: lab.run(f"{CASE}/scene.yaml", tools.label(f"{name}_{lab.level}"), {"mesh.size": sizes[name], **VARIANTS[name][0]}) for name in sizes}
    if lab.level == "full":
        runs["peak, slice in 3-D"] = lab.run(f"{CASE}/scene_slice.yaml", "slice", {})
    runs = tools.ends(runs)
    lab.figure(CASE, "verification_slope", lambda figure: draw(figure, runs, data), size=(7.2, 2.6),
               caption="Free surface 7.2 s after the start of the failure.")
    results = [result for name, run in runs.items() for result in judge(name, run, data, info, sizes[name] if name in sizes and VARIANTS[name][1] else None)]
    if lab.level == "full":
        results += tools.module(CASE, "length").evaluate(lab, CASE, SOFTENING, toe, spacing)
    return results
