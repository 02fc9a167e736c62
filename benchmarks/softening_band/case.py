"""A shear band in a layer that softens, a block of metal sheared off and a plate torn: width and work on several meshes, with a softening length and without."""
import numpy as np

import lab as tools

CASE = "softening_band"
SIZES = {12: "quick", 24: "full", 48: "full"}  # cells over the thickness: 6, 12 and 24 over the band
ENDS = {6.5: "quick", 6.6: "full", 6.7: "full"}  # m: gmsh then makes other triangles
METALS = {  # scene: side whose reaction is the force, cells [mm] with their level; 3, 4, 6 and 8 cells over twice the length
    "metal": ("reaction_y_max_x", {0.667: "quick", 0.5: "quick", 0.333: "full"}),
    "crack": ("reaction_upper_y", {0.667: "full", 0.5: "full", 0.333: "full", 0.25: "full"})}
REPORTED = ("reported", None, None, "")
MIDDLE = (2, 4)  # m: the part of the layer that is measured


def middle(frame):
    """Which particles are in the middle part of the layer."""
    x = frame["position"][:, 0]
    return (x > MIDDLE[0]) & (x < MIDDLE[1])


def frame_at(run, time):
    """The particle file of a time."""
    return min(run.frames, key=lambda frame: abs(frame.time - time))


def width(run, data):
    """Width of the band [m]: that of a band of the closed form p(x) with the same (integral of p)^2 / integral of p^2, where p is what has flowed
    while the strength fell."""
    begin, end = (frame_at(run, data[key]) for key in ("begin of the fall [s]", "end of the fall [s]"))
    order = {number: i for i, number in enumerate(begin["id"])}
    rows = [order[number] for number in end["id"]]
    strain = end["plastic_strain"] - begin["plastic_strain"][rows]
    inside = middle(end)
    volume, strain = end["volume"][inside], strain[inside]
    ratio = (strain * volume).sum()**2 / (strain**2 * volume).sum() / (MIDDLE[1] - MIDDLE[0])
    quarter = 0.75 * np.pi  # half a band in units of the length of the average
    return ratio * 2 * quarter * (3 * np.pi + 3) / (1.5 * np.pi + 2)**2


def slip_when_softened(data):
    """Slip across the band [m] at which the strength has fallen to the residual one."""
    return np.sqrt(3) * (1.5 * np.pi + 2) * 4 / 3 * data["softening length [m]"] * data["softening strain"]


def fall(run, data):
    """Shear stress lost by plastic slip [Pa/m] while the strength falls."""
    rows = []
    for key in ("begin of the fall [s]", "end of the fall [s]"):
        frame = frame_at(run, data[key])
        inside = middle(frame)
        volume = frame["volume"][inside]
        rows.append((np.average(frame["stress"][inside, 3], weights=volume),
                     np.sqrt(3) * (frame["plastic_strain"][inside] * volume).sum() / (MIDDLE[1] - MIDDLE[0])))
    (before, slip_before), (after, slip_after) = rows
    return (before - after) / (slip_after - slip_before)


def work(run, data):
    """Plastic work by area of the layer [J/m^2] at the end."""
    frame = run.last_frame()
    inside = middle(frame)
    return (frame["plastic_work"] * frame["mass"])[inside].sum() / data["density [kg/m^3]"] / (MIDDLE[1] - MIDDLE[0])


def measures(run, coarsest, data, what):
    """Width, fall of the stress and work of one run; the work beside that of the coarsest mesh."""
    peak, residual = data["peak and residual strength [Pa]"]
    width_exact, fall_exact = 2 * np.pi * data["softening length [m]"], (peak - residual) / slip_when_softened(data)
    results = [
        tools.Result(CASE, f"width of the band, {what}", "m", width(run, data), "within", data["slack of the width"], width_exact, data["source"], run),
        tools.Result(CASE, f"shear stress lost by slip, {what}", "Pa/m", fall(run, data), "within", data["slack of the work"], fall_exact, data["source"], run)]
    if run is not coarsest:
        results.append(tools.Result(CASE, f"plastic work by area, {what}", "J/m^2", work(run, data), "within", data["slack of the work"],
                                    work(coarsest, data), "the coarsest mesh", run))
    return results


def profile(run):
    """Height [m] and plastic strain at the end of the middle part, in slices."""
    frame = run.last_frame()
    inside = middle(frame)
    y, strain, volume = frame["position"][inside, 1], frame["plastic_strain"][inside], frame["volume"][inside]
    edges = np.linspace(0, 1, 37)
    weight, weighted = (np.histogram(y, edges, weights=w)[0] for w in (volume, volume * strain))
    filled = weight > 0
    return 0.5 * (edges[1:] + edges[:-1])[filled], weighted[filled] / weight[filled]


def stress(run):
    """Time [s] and mean shear stress of the middle part [Pa]."""
    rows = []
    for frame in run.frames:
        inside = middle(frame)
        rows.append((frame.time, np.average(frame["stress"][inside, 3], weights=frame["volume"][inside])))
    return np.array(rows).T


def draw(figure, with_length, without, data):
    """Profile of the plastic strain, and stress over time."""
    left, right = figure.subplots(1, 2)
    for runs, line in ((with_length, "-"), (without, ":")):
        for cells, run in runs.items():
            y, strain = profile(run)
            left.plot(strain, y, line, label=f"{cells} cells" + ("" if line == "-" else ", no length"))
            right.plot(*stress(run), line)
    peak, residual = data["peak and residual strength [Pa]"]
    softening = slip_when_softened(data)
    slips = np.array([0, softening, 2 * softening])
    strength = np.array([peak, residual, residual])
    right.plot((slips + strength / data["shear modulus [Pa]"]) / data["speed of the plates apart [m/s]"], strength, "k--", label="closed form")
    left.set(xlabel="plastic strain", ylabel="height [m]")
    right.set(xlabel="time [s]", ylabel="shear stress [Pa]", xlim=(0, 1.6))
    left.legend()
    right.legend()


def fracture(run, side, data):
    """Motion of the sides apart [m] at which the force has fallen to half its peak, and that peak [N/m]."""
    motion = data["speed of the sides of the metal apart [m/s]"] * run.history["time"]
    force = np.abs(run.history[side])
    peak = force.argmax()
    fallen = peak + np.argmax(force[peak:] < force[peak] / 2)
    return motion[fallen], force[peak]


def evaluate_metal(lab, scene):
    """Results of a block of metal that is sheared off, or of a plate that is torn: plastic work to the end, when it is in two."""
    data = tools.reference(CASE)
    side, levels = METALS[scene]
    length = {"materials[0].damage.softening_length": data["softening length of the metal [m]"]}
    sizes = [size for size, level in levels.items() if lab.level in ("full", level)]

    def run(size, settings, label):
        return lab.run(f"{CASE}/{scene}.yaml", tools.label(f"{label}_{size}"), {"mesh.size": size * 1e-3, **settings})

    averaged = {size: run(size, length, scene) for size in sizes}
    without = {size: run(size, {}, f"{scene}_without") for size in sizes if lab.level == "full"}
    results = []
    for label, runs in (("", averaged), (", no length", without)):
        for size, one in runs.items():
            what = f"{scene}, cells of {size:g} mm{label}"
            motion, force = fracture(one, side, data)
            checked = runs is averaged and size != sizes[0]
            against = ("within", data["slack of the work of the metal"], averaged[sizes[0]].history["plastic"][-1], "the coarsest mesh")
            results += [tools.Result(CASE, f"plastic work, {what}", "J/m", one.history["plastic"][-1], *(against if checked else REPORTED), one),
                        tools.Result(CASE, f"motion of the sides at half the peak force, {what}", "m", motion, *REPORTED, one),
                        tools.Result(CASE, f"peak force, {what}", "N/m", force, *REPORTED, one)]
    return results


def evaluate(lab):
    """Results of a shear band, a block of metal and a plate of metal."""
    data = tools.reference(CASE)
    length = {"materials[0].softening_length": data["softening length [m]"]}

    def run(cells, end, settings, label):
        sizes = {"mesh.size": 1 / cells, "mesh.regions[0].shape.high": [end, 1]}
        return lab.run(f"{CASE}/scene.yaml", tools.label(f"{label}_{cells}_{end}"), {**sizes, **settings})

    meshes = [(cells, end) for cells in SIZES for end in ENDS if lab.level == "full" or (SIZES[cells], ENDS[end]) == ("quick", "quick")]
    cone = {mesh: run(*mesh, length, "cone") for mesh in meshes}
    laws = {law: run(12, 6.5, {"bodies[0].material": name, f"materials[{i}].softening_length": data["softening length [m]"]}, name)
            for i, (name, law) in enumerate({"planes": "mohr_coulomb", "mises": "von_mises"}.items(), start=1)}
    without = {cells: run(cells, 6.5, {}, "without") for cells in SIZES if (cells, 6.5) in meshes and cells < 48}
    coarsest = cone[12, 6.5]
    results = [result for (cells, end), one in cone.items() for result in measures(one, coarsest, data, f"{cells} cells, channel to {end} m")]
    for law, one in laws.items():
        results += measures(one, coarsest, data, f"12 cells, {law}")
    if lab.level == "full":
        for kernel, scheme in tools.SUITED.items():
            if kernel != "projected":
                other = run(12, 6.5, {**length, "kernel": kernel, "transfer.scheme": scheme}, kernel)
                results += measures(other, coarsest, data, f"12 cells, {kernel}")
    for cells, one in without.items():
        results += [tools.Result(CASE, f"width of the band without a length, {cells} cells", "m", width(one, data), "reported", None, None, "", one),
                    tools.Result(CASE, f"plastic work by area without a length, {cells} cells", "J/m^2", work(one, data), "reported", None, None, "", one)]
    with_length = {cells: cone[cells, 6.5] for cells in SIZES if (cells, 6.5) in cone}
    lab.figure(CASE, "verification_softening_band", lambda figure: draw(figure, with_length, without, data), size=(8, 3.6),
               caption="Plastic strain and shear stress of a softening layer with a softening length (lines) and without (dots).")
    return results + [result for scene in METALS for result in evaluate_metal(lab, scene)]
