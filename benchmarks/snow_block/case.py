"""Confined compression of blocks of snow (laws snow and cohesive_cam_clay) beside the laws of one point."""
import numpy as np

import lab as tools

CASE = "snow_block"
SIZES = {0.125: "quick", 0.0625: "full"}  # m: 8 and 16 cells over the side
TOPS = {1.1: "quick", 1.13: "full", 1.16: "full"}  # m, the upper end of the room: gmsh then makes other meshes
SCENES = {"snow": "scene.yaml", "firn": "firn.yaml"}
STEPS = 20000
LAST = 0.35  # of the volume, compressed


def snow(own):
    """Volume ratio, axial and lateral pressure [Pa] of the law snow in uniaxial strain."""
    ratio = np.linspace(1, 1 - LAST, STEPS)
    smallest = 1 - own["critical_compression"]
    stretch = np.maximum(ratio, smallest)
    poisson = own["poisson_ratio"]
    confined = own["youngs_modulus"] * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
    axial = np.exp(own["hardening"] * (1 - ratio / stretch)) * confined * (1 - stretch) * stretch / ratio
    return ratio, axial, poisson / (1 - poisson) * axial


def firn(own):
    """The same of cohesive_cam_clay with linear elasticity: Kirchhoff stress over logarithmic strain, by rates with the tangent of associated flow."""
    bulk, beta, slope, factor = own["bulk_modulus"], own["cohesion_ratio"], own["critical_state_slope"], own["hardening_factor"]
    elastic = 2 * own["shear_modulus"] * (np.eye(3) - 1 / 3) + bulk
    stress, strain, compaction = np.zeros(3), np.zeros(3), np.arcsinh(own["preconsolidation_pressure"] / bulk) / factor
    step = np.array([0, np.log(1 - LAST) / STEPS, 0])
    rows = []
    for _ in range(STEPS + 1):
        ratio = np.exp(strain.sum())
        rows.append([ratio, -stress[1] / ratio, -stress[0] / ratio])
        limit = bulk * np.sinh(factor * compaction)
        p = -stress.mean()
        s = stress + p
        flow, compacted = np.zeros(3), 0
        if 1.5 * s @ s * (1 + 2 * beta) + slope**2 * (p + beta * limit) * (p - limit) >= -1e-6 * limit**2:
            to_p = slope**2 * (2 * p - (1 - beta) * limit)  # derivative of the yield function by p
            normal = 3 * (1 + 2 * beta) * s - to_p / 3
            to_limit = slope**2 * (beta * (p - limit) - (p + beta * limit))
            hardening = -to_limit * bulk * factor * np.cosh(factor * compaction) * to_p
            multiplier = max(normal @ elastic @ step / (normal @ elastic @ normal + hardening), 0)
            flow, compacted = multiplier * normal, multiplier * to_p
        stress = stress + elastic @ (step - flow)
        strain = strain + step
        compaction += compacted
    return np.array(rows).T


LAWS = {"snow": snow, "firn": firn}


def measured(run, pressure):
    """Of each frame, which are equally far in time: pressure on the upper side, mean axial and lateral pressure in the block [Pa], volume ratio, spread of the axial one over its mean."""
    rows, first = [], run.frames[0]
    for number, frame in enumerate(run.frames[1:], 1):
        weight = frame["volume"] / frame["volume"].sum()
        axial, lateral = -weight @ frame["stress"][:, 1], -weight @ frame["stress"][:, 0]
        spread = np.sqrt(weight @ (frame["stress"][:, 1] + axial) ** 2) / axial
        rows.append([pressure * number / (len(run.frames) - 1), axial, lateral, frame["volume"].sum() / first["volume"].sum(), spread])
    return np.array(rows).T


def judge(name, size, top, run, exact, data):
    """Volume ratio and ratio of stresses at some pressures."""
    own = data[name]
    ratio, axial, lateral = exact
    load, mean, side, volume, _ = measured(run, own["pressure [Pa]"])
    where = f"{name}, cells of {size} m" + ("" if top == 1.1 else f", room {top} m high")
    results = []
    for pressure in own["pressures [Pa]"]:
        results.append(tools.Result(CASE, f"compression at {pressure / 1e3:g} kPa, {where}", "-", float(1 - np.interp(pressure, load, volume)), "within", data["slack"],
                                    float(1 - np.interp(pressure, axial, ratio)), own["source"], run))
        results.append(tools.Result(CASE, f"lateral over axial pressure at {pressure / 1e3:g} kPa, {where}", "-", float(np.interp(pressure, load, side / mean)), "within",
                                    data["slack"], float(np.interp(pressure, axial[1:], lateral[1:] / axial[1:])), own["source"], run))
    return results


def draw(figure, runs, exact, data):
    """Pressure over compression."""
    for axis, name in zip(figure.subplots(1, 2), SCENES):
        ratio, axial, lateral = exact[name]
        shown = axial < data[name]["pressure [Pa]"]
        axis.plot(1 - ratio[shown], axial[shown] / 1e3, "k", label="law of one point, axial")
        axis.plot(1 - ratio[shown], lateral[shown] / 1e3, "k--", label="lateral")
        for colour, size in enumerate(size for size in SIZES if (name, size, 1.1) in runs):
            _, mean, side, volume, _ = measured(runs[name, size, 1.1], data[name]["pressure [Pa]"])
            axis.plot(1 - volume[4::5], mean[4::5] / 1e3, "o", ms=3, fillstyle="none", color=f"C{colour}", label=f"cells of {size} m")
            axis.plot(1 - volume[4::5], side[4::5] / 1e3, "s", ms=3, fillstyle="none", color=f"C{colour}")
        axis.set(xlabel="compression", ylabel="pressure [kPa]", title="snow" if name == "snow" else "cohesive_cam_clay")
        axis.legend(fontsize=7)


def evaluate(lab):
    """Results of both blocks, on all meshes of this level."""
    data = tools.reference(CASE)
    exact = {name: LAWS[name](data[name]["law"]) for name in SCENES}
    runs = tools.ends({(name, size, top): lab.run(f"{CASE}/{scene}", tools.label(f"{name}_{size}_{top}"), {"mesh.size": size, "mesh.regions[0].shape.high": [1, top]})
                       for name, scene in SCENES.items() for size in SIZES for top in TOPS if lab.level == "full" or {SIZES[size], TOPS[top]} == {"quick"}})
    lab.figure(CASE, "verification_snow_block", lambda figure: draw(figure, runs, exact, data), size=(8, 3.6),
               caption="Confined compression of blocks of snow beside the laws of one point.")
    return [result for (name, size, top), run in runs.items() for result in judge(name, size, top, run, exact[name], data)]
