"""Water that flows through soil: rain on a column, an infinite slope with seepage along it, and a saturated column that collapses."""
import numpy as np
import scipy.linalg

import lab as tools

CASE = "seepage"
COLUMNS = {0.1: "quick", 0.05: "full", 0.025: "full"}  # m
HEADS = (1, 2, 4, 5, 6, 8)  # s, of the pressure heads that are compared
FRONTS = (5, 6)  # s
SLOPES = {0.25: ("quick", 1.34, 1.5), 0.1667: ("full", 1.34, 1.5), 0.125: ("full", 1.36, 1.44)}  # m: level, range of the search
RINGS = {0.25: ("quick", 1.4, 1.66), 0.1667: ("full", 1.46, 1.56), 0.125: ("full", 1.5, 1.56)}  # m: level, range of the search
HEAPS = {0.0125: "quick", 0.00833: "full"}  # m
PERMEABILITIES = {1e-6: "quick", 1e-3: "full", 1e-1: "quick"}  # m/s
BODY = "{{body: column, porosity: 0.4, permeability: {:g}}}"  # whose pores stay full
SUDDEN = {"water.table": {"elevation": 0}, "water.flow.heads[0].table": [[0, 0], [1, 0]], "stages[0].duration": 1}  # pressure zero, nothing holds the water


def saturation(head, data):
    """Effective saturation of van Genuchten at a pressure head [m]."""
    n = data["exponent"]
    return (1 + (np.maximum(-head, 0) * data["alpha [1/m]"])**n)**(1 / n - 1)


def conductance(head, data):
    """Relative permeability of Mualem."""
    m, full = 1 - 1 / data["exponent"], saturation(head, data)
    return np.sqrt(full) * (1 - (1 - full**(1 / m))**m)**2


def content(head, data):
    """Volume of water over volume."""
    low, high = data["residual water content"], data["saturated water content"]
    return low + (high - low) * saturation(head, data)


def picard(old, dt, level, rain, data):
    """Heads of the cells after an implicit step, by the iteration of Celia et al. 1990; None where it does not converge."""
    dz, k = data["height [m]"] / len(old), data["permeability [m/s]"]
    head, tiny = old.copy(), 1e-7
    for _ in range(60):
        mobile = k * conductance(head, data)
        face = np.concatenate([[(k + mobile[0]) / 2], (mobile[1:] + mobile[:-1]) / 2])
        slope = face / dz * np.where(np.arange(len(face)) == 0, 2, 1)
        capacity = (content(head + tiny, data) - content(head - tiny, data)) / (2 * tiny) + 1e-9
        upward = np.append(-slope * np.diff(head, prepend=level) - face, -rain)
        bands = np.zeros((3, len(old)))
        bands[1] = dz / dt * capacity + slope + np.append(slope[1:], 0)
        bands[0, 1:] = bands[2, :-1] = -slope[1:]
        change = scipy.linalg.solve_banded((1, 1), bands, -(dz / dt * (content(head, data) - content(old, data)) + np.diff(upward)))
        head = head + change
        if np.abs(change).max() < 1e-8:
            return head
    return None


def richards(data, times, fall, cells=400, longest=0.005):
    """Heights of the cells, and {time: heads} of a column whose water at the foot sinks from the top in `fall` [s]; 0: heads that begin at zero."""
    height, wet = data["height [m]"], data["begin of the rain [s]"]
    z = (np.arange(cells) + 0.5) * height / cells
    head, time, found = (height - z if fall else np.zeros(cells)), 0.0, {}
    for event in sorted({*times, *(t for t in (fall, wet) if t <= max(times))}):
        step = longest / 1000
        while time < event - 1e-12:
            dt = min(step, event - time)
            level = max(0, height * (1 - (time + dt) / fall)) if fall else 0
            new = picard(head, dt, level, data["rain [m/s]"] if time + dt / 2 > wet else 0, data)
            step = dt / 2 if new is None else min(longest, 1.3 * step)
            if new is not None:
                head, time = new, time + dt
        found[event] = head
    return z, found


def heads(run, time, weight):
    """Heights and pressure heads of the particles at a time."""
    frame = min(run.frames, key=lambda one: abs(one.time - time))
    return frame["position"][:, 1], frame["pore_pressure"] / weight


def head_error(run, time, weight, exact):
    """Error of the pressure heads of particles [m], root mean square; exact = richards()."""
    y, found = heads(run, time, weight)
    return tools.rms(found - np.interp(y, exact[0], exact[1][time]))


def front(z, before, now, data):
    """Depth [m] at which the water content has risen by half of its rise at the top."""
    rise = content(now, data) - content(before, data)
    half, last = rise[-1] / 2, int(np.nonzero(rise < rise[-1] / 2)[0][-1])
    return data["height [m]"] - float(np.interp(half, rise[last:last + 2], z[last:last + 2]))


def profile(run, time, data, weight, size):
    """Pressure heads of a run over height: means over half a cell."""
    y, found = heads(run, time, weight)
    row = np.floor(y / size * 2).astype(int)
    rows = np.unique(row)
    return np.array([y[row == one].mean() for one in rows]), np.array([found[row == one].mean() for one in rows])


def front_of(run, time, data, weight, size):
    """Depth of the wetting front of a run [m]."""
    z = np.linspace(0, data["height [m]"], 1001)
    before, now = (np.interp(z, *profile(run, at, data, weight, size)) for at in (data["begin of the rain [s]"], time))
    return front(z, before, now, data)


def let_out(run, data, weight):
    """Volume of water that the history says has left, over what the particles lack beside what has rained."""
    first, last = run.frames[0], run.frames[-1]
    full = data["saturated water content"]
    pores = last["volume"] - (1 - full) * first["volume"]  # grains keep their volume
    now = (pores * content(last["pore_pressure"] / weight, data) / full).sum()
    held = full * first["volume"].sum()
    return float(run.history["water_drained"][-1] / (held + run.history["water_inflow"][-1] - now))


def factor(data, dry=False, depth=1.0):
    """Factor of safety of an infinite slope in closed form, on a plane at a depth [m] across the slope."""
    angle, weight, water = np.radians(data["angle [deg]"]), data["unit weight of the soil [N/m^3]"], 0 if dry else data["unit weight of water [N/m^3]"]
    friction = np.tan(np.radians(data["friction angle [deg]"])) / np.tan(angle)
    return float(data["cohesion [Pa]"] / (weight * depth * np.sin(angle)) + (1 - water / weight) * friction)


def factor_without_ends(ring):
    """The same of soil without cohesion that shears steadily at constant volume, where sin(phi) takes the place of tan(phi) (Davis 1968)."""
    sine = np.tan(np.radians(ring["angle [deg]"])) / (1 - ring["unit weight of water [N/m^3]"] / ring["unit weight of the soil [N/m^3]"])
    return float(np.tan(np.radians(ring["friction angle [deg]"])) / np.tan(np.arcsin(sine)))


def ring_error(search, ring):
    """Error of the pressures of a ring over the largest, root mean square."""
    frame = tools.talus.Run(search.folder / "at_rest").particles[-1]
    depth = ring["radius of the surface [m]"] - np.hypot(*frame["position"][:, :2].T)
    weight = ring["unit weight of water [N/m^3]"] * np.cos(np.radians(ring["angle [deg]"]))
    return tools.rms(frame["pore_pressure"] / weight - depth)


def mobilised(search, data):
    """Strength over shear stress near the base in the middle of the slope at rest, with their means; and the mean depth [m]."""
    frame = tools.talus.Run(search.folder / "at_rest").particles[-1]
    x, y, stress = frame["position"][:, 0], frame["position"][:, 1], frame["effective_stress"]
    near = (np.abs(x - data["length [m]"] / 2) < data["length [m]"] / 6) & (y < data["thickness [m]"] / 4)
    strength = data["cohesion [Pa]"] - stress[near, 1].mean() * np.tan(np.radians(data["friction angle [deg]"]))
    return float(strength / abs(stress[near, 3].mean())), float(data["thickness [m]"] - y[near].mean())


def slope_error(search, data, weight):
    """Error of the pressures in the middle third of a slope over the largest, root mean square."""
    frame = tools.talus.Run(search.folder / "at_rest").particles[-1]
    x, y = frame["position"][:, 0], frame["position"][:, 1]
    middle = np.abs(x - data["length [m]"] / 2) < data["length [m]"] / 6
    full = weight * np.cos(np.radians(data["angle [deg]"])) * data["thickness [m]"]
    return tools.rms(frame["pore_pressure"][middle] / full - (1 - y[middle] / data["thickness [m]"]))


def run_out(run, data):
    """Distance that 99 % of the mass do not exceed beyond the column, over its length."""
    return float(run.history["front"][-1] / data["length [m]"] - 1)


def grown(run):
    """Volume of all particles at the end over that at the beginning, less one."""
    return float(run.frames[-1]["volume"].sum() / run.frames[0]["volume"].sum() - 1)


def rain_results(runs, sudden, data, weight):
    """Heads, fronts and the balance of water of the columns."""
    z, exact = solution = richards(data, HEADS, 1)
    results = []

    def add(metric, unit, value, criterion, tolerance, reference, run):
        results.append(tools.Result(CASE, metric, unit, value, criterion, tolerance, reference, data["source"] if criterion != "reported" else "", run))

    for size, run in runs.items():
        for time in HEADS:
            add(f"error of the pressure head at {time} s, cells of {size:g} m", "m", head_error(run, time, weight, solution), "at most",
                data["slack of the head [m]"], 0.0, run)
        for time in FRONTS:
            add(f"depth of the wetting front at {time} s, cells of {size:g} m", "m", front_of(run, time, data, weight, size), "within",
                data["slack of the front"], front(z, exact[4], exact[time], data), run)
        add(f"water_drained over the water that has left, cells of {size:g} m", "-", let_out(run, data, weight), "within", data["slack of the water"], 1.0, run)
    add("error of the pressure head 1 s after full pores without pressure are opened at the foot", "m",
        head_error(sudden, 1, weight, richards(data, (1,), 0)), "at most", data["slack of the head [m]"], 0.0, sudden)
    add("water_drained over the water that has left, full pores opened at the foot", "-", let_out(sudden, data, weight), "within", data["slack of the water"],
        1.0, sudden)
    return results


def slope_results(searches, data, weight):
    """Pressures and factors of safety of the slopes."""
    results = []
    for name, (search, exact) in searches.items():
        run = search.trial(search.found["highest_that_holds"])
        results.append(tools.Result(CASE, f"factor of safety, {name}", "-", search.found["factor_of_safety"], "within", data["slack of the factor"], exact,
                                    data["source"], run))
        found, depth = mobilised(search, data)
        results.append(tools.Result(CASE, f"strength over shear stress near the base, {name}", "-", found, "within", data["slack of the factor"],
                                    factor(data, "base" in name, depth), data["source"], run))
        if name.startswith("cells"):
            results.append(tools.Result(CASE, f"error of the pressure in the middle of the slope, {name}", "-", slope_error(search, data, weight), "at most",
                                        data["slack of the pressure"], 0.0, data["source"], run))
    return results


def ring_results(searches, ring):
    """Pressures and factors of safety of layers that have no ends."""
    results = []
    for size, search in searches.items():
        run = search.trial(search.found["highest_that_holds"])
        results.append(tools.Result(CASE, f"factor of safety, layer without ends, cells of {size:g} m", "-", search.found["factor_of_safety"], "within",
                                    ring["slack of the factor"], factor_without_ends(ring), ring["source"], run))
        results.append(tools.Result(CASE, f"error of the pressure, layer without ends, cells of {size:g} m", "-", ring_error(search, ring), "at most",
                                    ring["slack of the pressure"], 0.0, ring["source"], run))
    return results


def heap_results(heaps, full, data):
    """Run-outs beside that of dry sand; and pressures and volume where pores stay full."""
    results, slow, fast = [], min(PERMEABILITIES), max(PERMEABILITIES)

    def add(metric, value, criterion, tolerance, reference, source, run):
        results.append(tools.Result(CASE, metric, "-", value, criterion, tolerance, reference, source, run))

    for (size, permeability), run in heaps.items():
        what = f"{'dry' if permeability is None else f'permeability of {permeability:g} m/s'}, cells of {size * 1000:.3g} mm"
        add(f"run-out (L - L0) / L0, {what}", run_out(run, data), "reported", None, None, "", run)
        if permeability in (slow, fast):
            add(f"run-out over that of dry sand, {what}", run_out(run, data) / run_out(heaps[size, None], data), "at least" if permeability == slow else "at most",
                1.0, None, data["source"], run)
    for permeability, run in full.items():
        add(f"run-out (L - L0) / L0, pores that stay full, permeability of {permeability:g} m/s", run_out(run, data), "reported", None, None, "", run)
        add(f"lowest pore pressure over the weight of the column, pores that stay full, permeability of {permeability:g} m/s",
            float(min(frame["pore_pressure"].min() for frame in run.frames) / data["weight [Pa]"]), "reported", None, None, "", run)
        if permeability == slow:
            add(f"growth of the volume, pores that stay full, permeability of {permeability:g} m/s", abs(grown(run)), "at most", data["slack of the volume"], 0.0,
                "water of 2.2 GPa that has no time to come in or leave", run)
    return results


def draw(figure, columns, heaps, data):
    """Pressure heads of the finest column over height, and deposits of the finest columns that collapsed."""
    left, right = figure.subplots(1, 2, width_ratios=[2, 3])
    z, exact = richards(data["rain"], HEADS, 1)
    for time in HEADS:
        y, found = heads(columns[min(columns)], time, data["unit weight [N/m^3]"])
        left.plot(found, y, ".", markersize=1.5, label=f"{time} s")
        left.plot(exact[time], z, "k-", linewidth=0.7)
    left.set(xlabel="pressure head [m]", ylabel="height [m]")
    left.legend(fontsize=7, markerscale=4)
    surface, finest = tools.module("column_collapse").surface, min(size for size, _ in heaps)
    for (size, permeability), run in heaps.items():
        if size == finest:
            x, y = surface(run.last_frame())
            right.plot(100 * x, 100 * y, label="dry" if permeability is None else f"k = {permeability:g} m/s")
    right.set(xlabel="x [cm]", ylabel="height of the deposit [cm]")
    right.legend(fontsize=7)


def evaluate(lab):
    """Results of the columns in the rain, of the slopes, of the layers without ends, and of the columns that collapse."""
    data = tools.reference(CASE)
    weight, slope = data["unit weight [N/m^3]"], {**data["slope"], "unit weight of water [N/m^3]": data["unit weight [N/m^3]"]}

    def wanted(level):
        return lab.level == "full" or level == "quick"

    def search(name, low, high, settings):
        return lab.fos(f"{CASE}/slope.yaml", tools.label(f"slope_{name}"), settings, bodies="layer", duration=2, share=0.5, width=0.02, **{"from": low, "to": high})

    columns = {size: lab.run(f"{CASE}/rain.yaml", f"rain_{size}", {"mesh.size": size}) for size, level in COLUMNS.items() if wanted(level)}
    sudden = lab.run(f"{CASE}/rain.yaml", "sudden", SUDDEN)
    heaps = {}
    for size, level in HEAPS.items():
        if wanted(level):
            heaps[size, None] = lab.run(f"{CASE}/dry.yaml", f"dry_{size}", {"mesh.size": size})
            for permeability, also in PERMEABILITIES.items():
                if wanted(also):
                    heaps[size, permeability] = lab.run(f"{CASE}/collapse.yaml", f"collapse_{size}_{permeability:g}",
                                                        {"mesh.size": size, "water.flow.bodies[0].permeability": permeability})
    full = {permeability: lab.run(f"{CASE}/collapse.yaml", f"full_{permeability:g}", {"water.flow.bodies[0]": BODY.format(permeability)})
            for permeability in PERMEABILITIES if lab.level == "full"}
    slopes = {}
    if lab.level == "full":
        slopes["base that drains"] = search("base", 1.95, 2.15, {"water.flow.drained": ["y_min"]}), factor(slope, dry=True)
    for size, (level, low, high) in SLOPES.items():
        if wanted(level):
            slopes[f"cells of {size:g} m"] = search(f"{size}", low, high, {"mesh.size": size}), factor(slope)
    rings = {size: lab.fos(f"{CASE}/ring.yaml", f"ring_{size}", {"mesh.size": size}, duration=4, share=0.5, width=0.02, **{"from": low, "to": high})
             for size, (level, low, high) in RINGS.items() if wanted(level)}
    results = rain_results(columns, sudden, data["rain"], weight) + slope_results(slopes, slope, weight)
    results += ring_results(rings, {**data["ring"], "unit weight of water [N/m^3]": weight}) + heap_results(heaps, full, data["collapse"])
    lab.figure(CASE, "verification_seepage", lambda figure: draw(figure, columns, heaps, data), size=(8, 3.6),
               caption="Pressure heads in a column that drains and is rained on (dots: particles, lines: Richards' equation), and deposits of saturated columns.")
    return results
