"""Taylor's test: final length and outline of rods of copper and steel against measured ones, with untuned constants."""
import numpy as np

import lab as tools

CASE = "taylor_bar"
MM = 1e-3
SHOTS = {
    "test 1": {},
    "test 2": {"mesh.geometry": "copper_2.geo", "materials[0].density": 8930, "materials[0].initial_temperature": 718,
               "bodies[0].velocity": [0, 0, -188], "stages[0].duration": 110e-6},
    "test 6": {"mesh.geometry": "copper_6.geo", "bodies[0].velocity": [0, 0, -316], "stages[0].duration": 110e-6},
}
SHOWN = {"quick": ["test 1"], "full": list(SHOTS)}
MESHES = {"quick": [3], "full": [3, 4, 6]}  # cells per radius
THRESHOLD = {"quick": [], "full": ["test 1", "test 2"]}  # by the mechanical threshold: copper that was annealed or is hot
OTHER = {"quick": 2, "full": 3}  # cells per radius of test 1 with another method
VARIANTS = {"friction 0.1": {"boundaries[0].coefficient": 0.1}, "without averaging of volumes": {"bodies[0].f_bar": False}}


def outline(run):
    """Length of the rod, and a function height above its foot -> radius [m], from particles enlarged to the cubes of their volumes.

    The rod rebounds: its foot has left the wall by the end.
    """
    frame = run.last_frame()
    x, size = frame["position"], np.cbrt(frame["volume"]) / 2
    radial = np.hypot(x[:, 0], x[:, 1]) + size
    layer, foot = 2 * float(np.mean(size)), float((x[:, 2] - size).min())

    def radius(height):
        return float(radial[np.abs(x[:, 2] - foot - height) < layer].max())

    return float((x[:, 2] + size).max()) - foot, radius


def measures(run, heights):
    """Final length, largest radius of the foot, radii at the given shares of the length [m]."""
    length, radius = outline(run)
    foot = max(radius(share * length) for share in np.linspace(0, 0.15, 8))
    return length, foot, [radius(share * length) for share in heights]


def draw(figure, runs, data):
    """Outlines over measured points."""
    axes = figure.subplots(1, len(runs), sharey=True)
    for axis, (shot, run) in zip(np.atleast_1d(axes), runs.items()):
        length, radius = outline(run)
        shares = np.linspace(0.01, 0.97, 60)
        axis.plot([radius(s * length) / MM for s in shares], shares * length / MM, lw=1, label="talus")
        known = data[shot]
        axis.plot(known["radii at heights [mm]"] + [known["foot radius [mm]"], 0], [s * known["final length [mm]"] for s in data["heights"]] + [0, known["final length [mm]"]], "o",
                  fillstyle="none", label="measured")
        axis.set(xlabel="radius [mm]", title=shot)
    np.atleast_1d(axes)[0].set_ylabel("height [mm]")
    np.atleast_1d(axes)[0].legend()


def evaluate(lab):
    """A shot of copper on the coarsest mesh, and with another method; at full level three on all meshes, two by another law, the first with friction and without averaging, and steel."""
    data, results, pictured = tools.reference(CASE), [], {}

    def judge(shot, run, note):
        known = data[shot]
        length, foot, radii = measures(run, data["heights"])
        results.append(tools.Result(CASE, f"{shot}: final length, {note}", "mm", length / MM, "within", 0.03, known["final length [mm]"], data["source"], run))
        results.append(tools.Result(CASE, f"{shot}: radius of the foot, {note}", "mm", foot / MM, "reported", None, known["foot radius [mm]"], data["source"], run))
        error = max(abs(r / MM / k - 1) for r, k in zip(radii, known["radii at heights [mm]"]))
        results.append(tools.Result(CASE, f"{shot}: largest error of five radii, {note}", "-", error, "reported", None, 0.0, data["source"], run))

    asked, steels = [], {}
    for shot in SHOWN[lab.level]:
        for count in MESHES[lab.level]:
            size = data[shot]["radius [mm]"] * MM / count
            asked.append((shot, f"{count} cells per radius", lab.run(f"{CASE}/scene.yaml", f"{shot.replace(' ', '_')}_{count}", {**SHOTS[shot], "mesh.size": size})))
    for shot in THRESHOLD[lab.level]:
        for count in MESHES[lab.level]:
            size = data[shot]["radius [mm]"] * MM / count
            run = lab.run(f"{CASE}/scene_threshold.yaml", f"threshold_{shot.replace(' ', '_')}_{count}", {**SHOTS[shot], "mesh.size": size})
            asked.append((shot, f"mechanical threshold, {count} cells per radius", run))
    count = OTHER[lab.level]
    asked.append(("test 1", f"projected, aflip, {count} cells to the radius", lab.run(f"{CASE}/scene.yaml", f"test_1_projected_{count}", {
        "mesh.size": data["test 1"]["radius [mm]"] * MM / count, **tools.METHODS["projected, aflip"]})))
    if lab.level == "full":
        size = data["test 1"]["radius [mm]"] * MM / 4
        for name, settings in VARIANTS.items():
            asked.append(("test 1", name, lab.run(f"{CASE}/scene.yaml", f"test_1_{name.replace(' ', '_')}", {**settings, "mesh.size": size})))
        steels = {friction: lab.run(f"{CASE}/scene_steel.yaml", f"steel_{friction}", {"boundaries[0].coefficient": friction}) for friction in (0, 0.1)}
    for shot, note, run in asked:
        judge(shot, run, note)
        if note.endswith("cells per radius") and not note.startswith("mechanical"):
            pictured[shot] = run
    steel = data["steel"]
    for friction, run in steels.items():
        length, foot, _ = measures(run, data["heights"])
        results.append(tools.Result(CASE, f"steel: final length over length, friction {friction}", "-", length / MM / steel["length [mm]"], "within", 0.03,
                                    steel["final length over length"], steel["source"], run))
        results.append(tools.Result(CASE, f"steel: radius of the foot, friction {friction}", "mm", foot / MM, "reported", None, steel["foot radius [mm]"], steel["source"], run))
    lab.figure(CASE, "verification_taylor", lambda figure: draw(figure, pictured, data), size=(7.4, 4), caption="Outlines of copper rods after impact.")
    return results
