"""Dry grains on an inclined plane: sliding, a dam break, and what a wall across the chute feels, beside closed forms and balances."""
import numpy as np

import lab as tools

CASE = "granular_chute"
ABOVE = 0.05  # m, room over the chute where there is no pile
STATION = 0.1  # m, length along the chute over which the flow that arrives is averaged
STRIP = 0.25  # of the depth before, over which depths are averaged
TIMES = [0.4, 0.7, 1.0, 1.4]  # s, at which the depth of the dam break is compared
VARIANTS = {  # name, method, cells over the depth of the chute and of the dam break; the first is run at every level
    "projected, aflip": ({}, 6, 8), "projected, aflip, cells half as large": ({}, 12, 16), "umls, tpic": (tools.METHODS["umls, tpic"], 6, 8)}


def turned(gravity, angle):
    """Gravity along and out of a plane inclined by `angle` [rad]."""
    return [float(gravity * np.sin(angle)), float(-gravity * np.cos(angle))]


def earth_pressure(inner, base):
    """Active and passive coefficient: stress along the base over stress normal to it where grains with the friction angle `inner` [rad] spread or are
    compressed while they slide on a base with the friction angle `base` (Savage & Hutter 1989)."""
    square = np.cos(inner) ** 2
    root = np.sqrt(1 - square * (1 + np.tan(base) ** 2))
    return 2 * (1 - root) / square - 1, 2 * (1 + root) / square - 1


def band(low, high):
    """What 'near' asks for: half the width and the middle."""
    return (high - low) / 2, (high + low) / 2


class DamBreak:
    """Closed form of a slab of infinite length, released at x = 0 with the depth h0, that runs down a plane on Coulomb friction: seen from what slides
    with m = g cos a (tan a - tan delta) it is the dam break of Ritter. `pressure` is the coefficient of earth pressure."""

    def __init__(self, data, pressure):
        own, angle = data["dam"], np.radians(data["dam"]["angle [deg]"])
        normal = data["gravity [m/s^2]"] * np.cos(angle)
        self.depth = own["depth [m]"]
        self.slide = normal * (np.tan(angle) - np.tan(np.radians(own["base friction angle [deg]"])))
        self.stiffness = pressure * normal
        self.wave = np.sqrt(self.stiffness * self.depth)

    def ends(self, time):
        """x [m] of the wave into the slab and of the front."""
        moved = self.slide * time**2 / 2
        return moved - self.wave * time, moved + 2 * self.wave * time

    def at(self, x, time):
        """Depth [m]."""
        back, front = self.ends(time)
        fan = (2 * self.wave - x / time + self.slide * time / 2) ** 2 / (9 * self.stiffness)
        return np.where(x < back, self.depth, np.where(x > front, 0, fan))

    def place(self, depth, time):
        """x [m] at which it is `depth` deep."""
        return float(self.ends(time)[1] - 3 * np.sqrt(self.stiffness * depth) * time)

    def shallowness(self, time):
        """Depth over the length of what the wave has reached: the size of what the equations of shallow flow leave out."""
        return float(self.depth / (3 * self.wave * time))


def depths(frame, width):
    """Depth [m] over strips of `width` along the chute (x of their middles, depth): area of the particles, taken as squares."""
    x, half = frame["position"][:, 0], np.sqrt(frame["volume"]) / 2
    edges = np.arange(np.floor(x.min() / width) - 1, np.ceil(x.max() / width) + 3) * width
    covered = [np.clip(np.minimum(x + half, high) - np.maximum(x - half, low), 0, None) / (2 * half) @ frame["volume"] for low, high in zip(edges, edges[1:])]
    return (edges[:-1] + edges[1:]) / 2, np.array(covered) / width


def farthest(x, y, depth):
    """Farthest x [m] at which the flow is `depth` deep."""
    last = int(np.nonzero(y > depth)[0][-1])
    return float(np.interp(depth, [y[last + 1], y[last]], [x[last + 1], x[last]]))


def acceleration(history, begin, end):
    """Of the centre of mass along the plane [m/s^2], straight line through its velocity."""
    chosen = (history["time"] >= begin) & (history["time"] <= end)
    return float(np.polyfit(history["time"][chosen], (history["momentum_x"] / history["mass"])[chosen], 1)[0])


def frame_at(run, time):
    """The particles at a time [s]; frames are a tenth of a second apart."""
    return run.frames[round(time / 0.1)]


def depth_error(run, closed, time):
    """Root mean square of the difference of depths over the depth before, over the fan of the closed form."""
    x, y = depths(frame_at(run, time), STRIP * closed.depth)
    back, front = closed.ends(time)
    inside = (x > back) & (x < front)
    return tools.rms((y - closed.at(x, time))[inside]) / closed.depth


def apart(closed, other, time):
    """Root mean square of the difference of two closed forms over the depth before, over the fan of the first."""
    x = np.linspace(*closed.ends(time), 1000)
    return tools.rms(closed.at(x, time) - other.at(x, time)) / closed.depth


def judge_dam(name, run, data, closed, isotropic):
    """Results of the dam break. Place: what shallow flow leaves out is of the order of depth over length, so no more than that is asked. Depth: to be nearer
    to the active coefficient of earth pressure than to equal normal stresses, with a factor of two."""
    own, slide, end = data["dam"], data["slide"], TIMES[-1]
    x, y = depths(frame_at(run, end), STRIP * closed.depth)
    thin = closed.depth / 10
    results = [
        tools.Result(CASE, f"dam break: acceleration of the centre of mass, {name}", "m/s^2", acceleration(run.history, own["late [s]"], end), "within",
                     slide["slack"], float(closed.slide), slide["source"], run),
        tools.Result(CASE, f"dam break: depth, rms over the depth before at {end} s, {name}", "-", depth_error(run, closed, end), "at most",
                     apart(closed, isotropic, end) / 2, 0.0, own["source"], run),
        tools.Result(CASE, f"dam break: x where a tenth as deep as before, {name}", "m", farthest(x, y, thin), "within", closed.shallowness(end),
                     closed.place(thin, end), own["source"], run)]
    results += [tools.Result(CASE, f"dam break: depth, rms over the depth before at {time} s, {name}", "-", depth_error(run, closed, time), "reported", None, 0.0,
                             own["source"], run) for time in TIMES[:-1]]
    return results + [tools.Result(CASE, f"dam break: depth beside that of equal normal stresses, rms at {end} s, {name}", "-",
                                   depth_error(run, isotropic, end), "reported", None, 0.0, own["isotropic source"], run)]


def chute(lab, name, method, cells, data, wall):
    """The run of a slab down the chute, with the wall or, to see what arrives at its place, with room beyond."""
    own = data["chute"]
    depth = own["depth [m]"]
    settings = {**method, "mesh.size": round(depth / cells, 7), "loads[0].acceleration": turned(data["gravity [m/s^2]"], np.radians(own["angle [deg]"]))}
    if not wall:
        length = own["wall x [m]"] + 1.8
        settings |= {"time.end": 1.2, "on_exit": "delete", "mesh.regions[2].shape.high": [length, depth],
                     "mesh.regions[3].shape.high": [length, depth + ABOVE]}
    return lab.run(f"{CASE}/scene.yaml", tools.label(f"{'wall' if wall else 'free'} {name}"), settings)


def arriving(run, data):
    """At the place of the wall without it: times [s], flux of momentum [N/m], depth [m], mass that has passed [kg/m]."""
    place, mass, rows = data["chute"]["wall x [m]"], run.history["mass"][0], []
    for number, frame in enumerate(run.frames):
        x, speed, own = frame["position"][:, 0], frame["velocity"][:, 0], frame["mass"]
        near = np.abs(x - place) < STATION / 2
        rows.append((0.02 * number, (own * speed**2)[near].sum() / STATION, frame["volume"][near].sum() / STATION, mass - own[x < place].sum()))
    return np.array(rows).T


def expected_peak(free, height, data):
    """Band of the largest force [N/m] from what arrives and what has stopped: see peak source in reference.json."""
    own, angle = data["chute"], np.radians(data["chute"]["angle [deg]"])
    _, flux, depth, stopped = arriving(free, data)
    along, across = data["gravity [m/s^2]"] * np.sin(angle), data["gravity [m/s^2]"] * np.cos(angle)
    return float(np.max(flux + stopped * (along - own["base friction"] * across))), float(np.max(flux * height / (height - depth) + stopped * along))


def judge_wall(name, run, free, data):
    """Results of the chute with the wall."""
    own, slide, history = data["chute"], data["slide"], run.history
    angle, gravity, mass = np.radians(own["angle [deg]"]), data["gravity [m/s^2]"], history["mass"][0]
    along, across = gravity * np.sin(angle), gravity * np.cos(angle)
    force, late = -history["reaction_x_max_x"], history["time"] > history["time"][-1] - 0.2
    acted = np.maximum(history["time"] - history["dt"] / 2, 0)  # [s]; momenta are those of half a step before the time of their row
    impulse = np.cumsum((history["reaction_y_min_x"] - force) * np.diff(history["time"], prepend=0)) + mass * along * acted
    x, depth = depths(run.last_frame(), own["depth [m]"] / 4)
    height, density = float(depth[x < own["wall x [m]"]][-1]), mass / float(np.sum(run.frames[0]["volume"]))
    pressures = earth_pressure(np.radians(own["friction angle [deg]"]), np.arctan(own["base friction"]))
    rest, peak = float(np.mean(force[late])), float(np.max(force))
    held = [mass * (along - sign * own["base friction"] * across) for sign in (1, -1)]
    frame = run.last_frame()
    return [
        tools.Result(CASE, f"chute: acceleration of the slab before the wall, {name}", "m/s^2", acceleration(history, *slide["from and to [s]"]), "within",
                     slide["slack"], float(along - own["base friction"] * across), slide["source"], run),
        tools.Result(CASE, f"wall: impulses beside the change of momentum, over the weight's, {name}", "-",
                     float(np.max(np.abs(impulse - history["momentum_x"])) / (mass * along * history["time"][-1])), "at most", own["balance"], 0.0,
                     own["balance source"], run),
        tools.Result(CASE, f"wall: largest force, {name}", "N/m", peak, "near", *band(*expected_peak(free, height, data)), own["peak source"], run),
        tools.Result(CASE, f"wall: largest force over the largest flux of momentum, {name}", "-", peak / float(np.max(arriving(free, data)[1])), "reported", None,
                     None, "", run),
        tools.Result(CASE, f"wall: force at rest, {name}", "N/m", rest, "near", *band(*held), own["rest source"], run),
        tools.Result(CASE, f"wall: coefficient of earth pressure at rest, {name}", "-", 2 * rest / (density * across * height**2), "near", *band(*pressures),
                     own["pressure source"], run),
        tools.Result(CASE, f"wall: height of the pile at the wall, {name}", "m", height, "reported", None, None, "", run),
        tools.Result(CASE, f"wall: speed at the end, rms, {name}", "m/s", float(np.sqrt(np.average(np.sum(frame["velocity"]**2, axis=1), weights=frame["mass"]))),
                     "reported", None, 0.0, "", run)]


def draw_dam(figure, run, closed):
    """Depth over place at three times."""
    axis = figure.subplots()
    for colour, time in enumerate(TIMES[1:]):
        x, y = depths(frame_at(run, time), STRIP * closed.depth)
        fine = np.linspace(-6, 9, 400)
        axis.plot(x, y, "o", ms=3, color=f"C{colour}", label=f"talus, {time:g} s")
        axis.plot(fine, closed.at(fine, time), color=f"C{colour}", label="closed form" if colour == 0 else None)
    axis.set(xlim=(-6, 8), xlabel="x down the plane [m]", ylabel="depth [m]")
    axis.legend()


def draw_wall(figure, run, free, data):
    """Force over time beside what arrives, and the piles."""
    left, right = figure.subplots(1, 2)
    angle, history, own = np.radians(data["chute"]["angle [deg]"]), run.history, data["chute"]
    weight = history["mass"][0] * data["gravity [m/s^2]"]
    left.plot(history["time"], -history["reaction_x_max_x"], "k", label="on the wall")
    left.plot(history["time"], history["reaction_y_min_x"], "0.6", label="friction of the base")
    times, flux, _, _ = arriving(free, data)
    left.plot(times, flux, "C0--", label="flux of momentum without the wall")
    left.axhspan(*(weight * (np.sin(angle) + sign * own["base friction"] * np.cos(angle)) for sign in (-1, 1)), color="C1", alpha=0.15, lw=0, label="possible at rest")
    left.set(xlabel="time [s]", ylabel="force [N/m]", ylim=(-650, 730))
    left.legend(fontsize=7, loc="lower right")
    for time in (0.6, 0.76, 0.92, 1.6):
        x, y = depths(run.frames[round(time / 0.02)], own["depth [m]"] / 4)
        right.step(x[x < own["wall x [m]"]], y[x < own["wall x [m]"]], where="mid", label=f"{time:g} s")
    right.axvline(own["wall x [m]"], color="k")
    right.set(xlim=(0.2, 1.25), xlabel="x down the chute [m]", ylabel="depth [m]")
    right.legend()


def evaluate(lab):
    """Results with the default method; at full level also with smaller cells and with another kernel."""
    data, dam = tools.reference(CASE), tools.reference(CASE)["dam"]
    active, _ = earth_pressure(np.radians(dam["friction angle [deg]"]), np.radians(dam["base friction angle [deg]"]))
    closed, isotropic = DamBreak(data, active), DamBreak(data, 1.0)
    gravity = turned(data["gravity [m/s^2]"], np.radians(dam["angle [deg]"]))
    plan = VARIANTS if lab.level == "full" else dict(list(VARIANTS.items())[:1])
    dams = {name: lab.run(f"{CASE}/dam_break.yaml", tools.label(f"dam {name}"),
                          {**method, "mesh.size": round(dam["depth [m]"] / cells, 7), "loads[0].acceleration": gravity})
            for name, (method, _, cells) in plan.items()}
    walls = {name: chute(lab, name, method, cells, data, wall=True) for name, (method, cells, _) in plan.items()}
    frees = {name: chute(lab, name, method, cells, data, wall=False) for name, (method, cells, _) in plan.items()}
    first = next(iter(plan))
    lab.figure(CASE, "verification_dam_break", lambda figure: draw_dam(figure, dams[first], closed), caption="Grains released on a plane of 20 degrees: depth "
               "beside the closed form of shallow flow.")
    lab.figure(CASE, "verification_chute", lambda figure: draw_wall(figure, walls[first], frees[first], data), size=(7.6, 3.2),
               caption="Grains that a wall stops on a chute of 40 degrees: forces and piles.")
    results = [result for name, run in tools.ends(dams).items() for result in judge_dam(name, run, data, closed, isotropic)]
    return results + [result for name, run in tools.ends(walls).items() if not frees[name].failure() for result in judge_wall(name, run, frees[name], data)]
