"""Cuts along facets of the mesh: a block that slides on one, a block that slides once the shear is large enough, a sheet with soil on both sides."""
import numpy as np

import lab as tools

CASE = "cut"
SIZES = {0.2: "quick", 0.1: "quick", 0.05: "full"}
SHEETS = {0.5: "quick", 0.25: "quick", 0.125: "full"}


def way(run, data):
    """Time since the block was let go [s], and how far it has come [m]."""
    time = run.history["time"] - data["released [s]"]
    after = time >= -1e-9
    return time[after], (run.history["middle_x"] - run.history["middle_x"][after][0])[after]


def acceleration(data):
    """Of a rigid block down the cut [m/s^2]."""
    angle = np.radians(data["angle [degrees]"])
    return data["gravity [m/s^2]"] * (np.sin(angle) - data["friction"] * np.cos(angle))


def judge_way(size, run, data):
    """The way at the end, relative to that of a rigid block."""
    time, came = way(run, data)
    exact = acceleration(data) * time[-1] ** 2 / 2
    return tools.Result(CASE, f"way, cells of {size} m", "m", float(came[-1]), "within", data["way slack"], float(exact), data["way source"], run)


def judge_ramp(size, run, data):
    """The load at which the block begins to slide, from its speed at the end, and its way before, at 0.98 of that load."""
    time, speed = run.history["time"], run.history["middle_vx"]
    rate, limit = data["rate [m/s^3]"], data["friction"] * data["gravity [m/s^2]"]
    began = time[-1] - np.sqrt(2 * speed[-1] / rate)
    load = data["start [m/s^2]"] + rate * (time - data["released [s]"])
    at_release = np.argmax(time >= data["released [s]"] - 1e-9)
    before = np.argmax(load >= 0.98 * limit)
    crept = run.history["middle_x"][before] - run.history["middle_x"][at_release]
    return [tools.Result(CASE, f"load at which it slides, over the limit, cells of {size} m", "-", float((data["start [m/s^2]"] + rate * (began - data["released [s]"])) / limit),
                         "within", data["limit slack"], 1.0, data["limit source"], run),
            tools.Result(CASE, f"way up to 0.98 of the limit, cells of {size} m", "m", float(crept), "reported", None, 0.0, data["limit source"], run)]


def judge_sheet(size, run, data):
    """The force on the sheet at rest."""
    nu = data["poisson"]
    high, low = data["heights [m]"]
    exact = nu / (1 - nu) * data["density [kg/m^3]"] * data["gravity [m/s^2]"] * (high**2 - low**2) / 2
    return tools.Result(CASE, f"force on the sheet, cells of {size} m", "N", float(-run.history["reaction_sheet_x"][-1]), "within", data["sheet slack"], float(exact),
                        data["sheet source"], run)


def draw(figure, runs, data):
    """Ways over time: the closed form as a line, runs as marks."""
    axis = figure.subplots()
    time, _ = way(next(iter(runs.values())), data)
    axis.plot(time, acceleration(data) * time**2 / 2, color="k", label="closed form")
    for mark, (size, run) in zip(("+", "o", "x"), runs.items()):
        times, came = way(run, data)
        axis.plot(times[::4], came[::4], mark, fillstyle="none", label=f"talus, cells of {size} m")
    axis.set(xlabel="time since it was let go [s]", ylabel="way of the middle of the block [m]")
    axis.legend(fontsize=6)


def start(lab):
    """Starts the runs of this level: blocks that are let go, blocks under growing shear and sheets, each by size of cells."""
    wanted = [size for size, level in SIZES.items() if lab.level in ("full", level)]
    return ({size: lab.run(f"{CASE}/scene.yaml", f"slides_{size}", {"mesh.size": size}) for size in wanted},
            {size: lab.run(f"{CASE}/scene_ramp.yaml", f"ramp_{size}", {"mesh.size": size}) for size in wanted},
            {size: lab.run(f"{CASE}/scene_sheet.yaml", f"sheet_{size}", {"mesh.size": size}) for size, level in SHEETS.items() if lab.level in ("full", level)})


def of_kernel(lab, data):
    """Starts them with another kernel, each with what measures it."""
    slides, ramps, sheets = start(lab)
    pairs = [(run, lambda size=size, run=run: [judge_way(size, run, data)]) for size, run in slides.items()]
    pairs += [(run, lambda size=size, run=run: judge_ramp(size, run, data)) for size, run in ramps.items()]
    return pairs + [(run, lambda size=size, run=run: [judge_sheet(size, run, data)]) for size, run in sheets.items()]


def evaluate(lab):
    """Results of blocks on cuts and of a sheet in soil."""
    data = tools.reference(CASE)
    slides, ramps, sheets = start(lab)
    results = [judge_way(size, run, data) for size, run in slides.items()]
    for size, run in ramps.items():
        results += judge_ramp(size, run, data)
    results += [judge_sheet(size, run, data) for size, run in sheets.items()]
    results += tools.with_other_kernels(lab, lambda other: of_kernel(other, data))
    lab.figure(CASE, "verification_cut", lambda figure: draw(figure, slides, data), caption="Way of a block down an inclined cut.")
    return results
