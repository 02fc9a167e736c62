"""Saturated soil that water cannot leave in time: a wave in a column (de Boer), and clay that is compressed undrained."""
import numpy as np

import lab as tools

CASE = "saturated_soil"
COLUMNS = {0.1: "quick", 0.05: "quick", 0.025: "quick", 0.0125: "full"}  # m
WIDTHS = {0.4: "quick", 0.41: "full", 0.42: "full"}  # m: gmsh then makes other triangles
BLOCKS = {0.25: "quick", 0.125: "quick", 0.0625: "full"}  # m
PLACES = {1.0: "quick", 1.02: "full", 1.04: "full"}  # m, width of the block: other triangles again
LOADS = ("at once", "over 6 ms")
STEPS = 20000


def bessel(x):
    """I0(x) exp(-x) of an array, by the mean over the half circle."""
    angle = (np.arange(64) + 0.5) * np.pi / 64
    return np.exp(np.multiply.outer(x, np.cos(angle) - 1)).mean(axis=-1)


def integral(values, ends):
    """The integral of values(x) from 0 to each of the `ends`, which may be arrays, by 60 points of Gauss."""
    at, weights = np.polynomial.legendre.leggauss(60)
    return sum(w * values(ends * (x + 1) / 2) for x, w in zip(at, weights)) * ends / 2


class Column:
    """Closed form of the telegraph equation rho u_tt + (gamma_w / k) u_t = M u_zz with -M u_z = f at z = 0, at rest before.

    Under a step the velocity behind the front at z = c t is f / sqrt(rho M) exp(-b t / 2) I0(b / 2 sqrt(t^2 - z^2 / c^2)), b = gamma_w / (k rho).
    """

    def __init__(self, data):
        modulus, self.density = data["modulus of the column [Pa]"], data["density of the column [kg/m^3]"]
        self.drag = data["unit weight [N/m^3]"] / data["permeability of the column [m/s]"]
        self.load, self.ramp, self.height = data["load of the column [Pa]"], data["ramp of the column [s]"], data["height of the column [m]"]
        self.wave, self.impedance = np.sqrt(modulus / self.density), np.sqrt(modulus * self.density)

    def velocity(self, z, t):
        half, since = self.drag / self.density / 2, np.sqrt(np.maximum(t**2 - (z / self.wave) ** 2, 0))
        return np.where(z < self.wave * t, self.load / self.impedance * np.exp(half * (since - t)) * bessel(half * since), 0)

    def displacement(self, z, t):
        first = np.minimum(z / self.wave, t)
        return integral(lambda since: self.velocity(z, first + since), t - first)

    def pressure(self, z, t):
        """Water below a layer moves with it relative to the grains, so that p_z = (gamma_w / k) u_t."""
        return self.drag * integral(lambda depth: self.velocity(depth, t), np.minimum(z, self.wave * t))

    def ramped(self, response, z, t):
        """A response to the load f sin^2(pi t / 2 r) that is whole after the ramp r."""
        end = min(self.ramp, t)
        return integral(lambda at: np.pi / 2 / self.ramp * np.sin(np.pi * at / self.ramp) * response(z, t - at), end)

    def table(self):
        """The ramp as the table of a load."""
        times = np.linspace(0, self.ramp, 25)
        return [[round(float(t), 8), round(float(np.sin(np.pi / 2 * t / self.ramp) ** 2), 8)] for t in times]

    def exact(self, load, z, t):
        """Displacement [m] and pressure [Pa] under one of the LOADS, by a table over the depth."""
        at = np.linspace(0, self.height, 1201)
        if load == LOADS[0]:
            found = self.displacement(at, t), self.pressure(at, t)
        else:
            found = self.ramped(self.displacement, at, t), self.ramped(self.pressure, at, t)
        return [np.interp(z, at, values) for values in found]


def column_errors(run, load, data):
    """Errors of the last frame: displacement over that of the surface, pressure over the load, and pressure ahead of the wave beside the closed form."""
    frame, exact = run.last_frame(), Column(data)
    z = data["height of the column [m]"] - (frame["position"] - frame["displacement"])[:, 1]
    moved, pressure = exact.exact(load, z, frame.time)
    surface = exact.exact(load, np.zeros(1), frame.time)[0][0]
    return tools.rms(-frame["displacement"][:, 1] - moved) / surface, tools.rms(frame["pore_pressure"] - pressure) / exact.load


def judge_columns(runs, data):
    """Errors of displacements and pressures of the columns {(load, size, width): run}, and their orders."""
    results, errors = [], {key: column_errors(run, key[0], data) for key, run in runs.items()}
    for (load, size, width), run in runs.items():
        for what, value in zip(("displacement", "pressure"), errors[load, size, width]):
            judged = size < 0.1
            results.append(tools.Result(CASE, f"column: error of the {what}, load {load}, cells of {size:g} m, {width:g} m wide", "-", value,
                                        "at most" if judged else "reported", data["slack of the column"] if judged else None, 0.0, data["source of the column"], run))
    for load in LOADS:
        for width in sorted({key[2] for key in runs}):
            sizes = [size for size in COLUMNS if (load, size, width) in runs]
            for number, what in enumerate(("displacement", "pressure")):
                order = tools.observed_order(sizes, [errors[load, size, width][number] for size in sizes])
                smooth = load != LOADS[0]
                results.append(tools.Result(CASE, f"column: order of the error of the {what}, load {load}, {width:g} m wide", "-", order,
                                            "at least" if smooth else "reported", data["order asked"] if smooth else None, 2.0 if smooth else 1.0,
                                            "linear shape functions" if smooth else "front of a wave", runs[load, sizes[-1], width]))
    return results


def path(data, last):
    """The law of one point, undrained: axial strain (logarithmic, positive in compression), p', q and pore pressure [Pa].

    No strain out of the plane and a constant lateral stress, so that the mean total stress is p0 + q / sqrt(3); the water takes up n p_w / K_w.
    """
    own, start = data["clay"], data["start of the clay [Pa]"]
    water = data["porosity of the clay"] / data["bulk modulus of the water [Pa]"]
    p, q, pc, axial, slope = start, 0.0, own["preconsolidation_pressure"], 0.0, own["critical_state_slope"] ** 2
    hardening = own["compression_index"] - own["swelling_index"]
    rows, step = [], last / STEPS
    for _ in range(STEPS + 1):
        rows.append([axial, p, q, start + q / np.sqrt(3) - p])
        bulk, shear = (p + own["reference_pressure"]) / own["swelling_index"], 3 * own["shear_modulus"]
        by_p, by_q = 2 * p - pc, 2 * q / slope  # gradient of the yield function
        yields = q**2 / slope + p * (p - pc) >= 0
        # unknowns dp, dq, plastic multiplier, volume strain
        matrix = np.array([[1, 0, bulk * by_p, -bulk], [0, 1, shear * by_q, shear / np.sqrt(3)], [by_p, by_q, -p * pc * by_p / hardening, 0],
                           [water, -water / np.sqrt(3), 0, 1]])
        if not yields:
            matrix[2] = [0, 0, 1, 0]
        dp, dq, multiplier, _ = np.linalg.solve(matrix, [0, shear * 2 / np.sqrt(3) * step, 0, 0])
        p, q, axial, pc = p + dp, q + dq, axial + step, pc * (1 + by_p * multiplier / hardening)
    return np.array(rows).T


def measured(run):
    """Of each frame of the flow: axial strain by the slope of the displacement over the height, p', q and pore pressure [Pa], spread of the latter [Pa]."""
    rows = []
    for frame in run.frames:
        weight = frame["volume"] / frame["volume"].sum()
        stress = weight @ frame["effective_stress"][:, :4]
        p = -stress[:3].mean()
        water = weight @ frame["pore_pressure"]
        slope = np.polyfit((frame["position"] - frame["displacement"])[:, 1], frame["displacement"][:, 1], 1)[0]
        rows.append([-np.log1p(slope), p, np.sqrt(1.5 * np.sum((stress[:3] + p) ** 2) + 3 * stress[3] ** 2), water,
                     np.sqrt(weight @ (frame["pore_pressure"] - water) ** 2)])
    return np.array(rows).T


def judge_block(name, run, exact, data, strains):
    """p', q and pore pressure at equal axial strains, and the spread of the pressure between particles."""
    results, (axial, *found, spread) = [], measured(run)
    for strain in strains:
        for what, values, law in zip(("p'", "q", "pore pressure"), found, exact[1:]):
            results.append(tools.Result(CASE, f"clay: {what} at an axial strain of {strain}, {name}", "Pa", float(np.interp(strain, axial, values)),
                                        "within", data["slack of the clay"],
                                        float(np.interp(strain, exact[0], law)), data["source of the clay"], run))
    last = data["strains of the clay"][-1]
    return [*results, tools.Result(CASE, f"clay: spread of the pore pressure between particles at an axial strain of {last}, rms over the mean, {name}", "-",
                                   float(np.interp(last, axial, spread / np.maximum(found[2], 1))), "reported", None, 0.0, "", run)]


def draw(figure, columns, blocks, exact, data):
    """Pressure over the depth of the finest columns; path of stress and pore pressure of the blocks."""
    left, centre, right = figure.subplots(1, 3)
    closed = Column(data)
    size, width = min(key[1] for key in columns), min(WIDTHS)
    for colour, load in enumerate(LOADS):
        for frame in columns[load, size, width].frames[1:]:
            z = data["height of the column [m]"] - (frame["position"] - frame["displacement"])[:, 1]
            depth = np.linspace(0, data["height of the column [m]"], 241)
            left.plot(frame["pore_pressure"] / closed.load, z, ".", markersize=1.5, color=f"C{colour}")
            left.plot(closed.exact(load, depth, frame.time)[1] / closed.load, depth, "k-", linewidth=0.7)
        left.plot([], [], ".", color=f"C{colour}", label=f"load {load}")
    left.invert_yaxis()
    left.set(xlabel="pore pressure over load", ylabel="depth of the column [m]")
    centre.plot(exact[1] / 1e3, exact[2] / 1e3, "k-", linewidth=0.8, label="law of one point")
    right.plot(100 * exact[0], exact[3] / 1e3, "k-", linewidth=0.8)
    for colour, (size, run) in enumerate(blocks.items()):
        axial, p, q, water, _ = measured(run)
        look = {"ms": 3, "fillstyle": "none", "color": f"C{colour}"}
        centre.plot(p / 1e3, q / 1e3, "o", label=f"cells of {size:g} m", **look)
        right.plot(100 * axial, water / 1e3, "o", **look)
    centre.set(xlabel="p' of the clay [kPa]", ylabel="q [kPa]")
    right.set(xlabel="axial strain of the clay [%]", ylabel="pore pressure [kPa]")
    left.legend(fontsize=7)
    centre.legend(fontsize=7)


def evaluate(lab):
    """Results of the columns and of the clay, on all meshes of this level."""
    data = tools.reference(CASE)

    def wanted(*levels):
        return lab.level == "full" or all(level == "quick" for level in levels)

    def column(load, size, width):
        settings = {"mesh.size": size, "mesh.regions[0].shape.high": [width, 1.2], "bodies[0].shape.high": [width, 1.2]}
        if load != LOADS[0]:
            settings["loads[0].table"] = Column(data).table()
        return lab.run(f"{CASE}/column.yaml", tools.label(f"column_{load}_{size}_{width}"), settings)

    def block(name, size, width=1.0, **settings):
        shapes = {"mesh.regions[0].shape.high": [width, 1], "bodies[0].shape.high": [width, 1]}
        return lab.run(f"{CASE}/clay.yaml", tools.label(f"{name}_{size}_{width}"), {"mesh.size": size, **shapes, **settings})

    columns = {(load, size, width): column(load, size, width)
               for load in LOADS for size, at in COLUMNS.items() for width, also in WIDTHS.items() if wanted(at, also)}
    blocks = {(size, width): block("clay", size, width)
              for size, at in BLOCKS.items() for width, also in PLACES.items() if wanted(at, also) and (size > 0.1 or width == 1)}
    tight = block("tight", 0.125, **{"water.flow.bodies[0].permeability": 1e-8})
    exact = path(data, 0.0056)
    lab.figure(CASE, "verification_saturated_soil", lambda figure: draw(figure, columns, {s: run for (s, width), run in blocks.items() if width == 1}, exact, data),
               size=(9, 3.4), caption="A wave in a saturated column beside the closed form (lines), and clay compressed undrained beside the law of one point.")
    results = judge_columns(columns, data)
    for (size, width), run in blocks.items():
        results += judge_block(f"cells of {size:g} m, {width:g} m wide", run, exact, data, data["strains of the clay"])
    return results + judge_block("cells of 0.125 m, permeability of 1e-8 m/s", tight, exact, data, [])
