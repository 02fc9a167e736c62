"""Factor of safety of a slope by strength reduction: runs with cohesion / F and tan(friction angle) / F, bisected between holding and failing."""
import numpy as np

import lab as tools

CASE = "factor_of_safety"
POINTS = ["crest", "middle", "toe"]


def reduced(data, soil, factor):
    """The material of the scene with its strength divided by a factor."""
    friction = np.degrees(np.arctan(np.tan(np.radians(data["friction angle [deg]"])) / factor))
    return {**data["constants"], **soil, "cohesion": data["cohesion [Pa]"] / factor, "friction_angle": float(friction)}


def motion(run):
    """Times [s] since the strength counts, and the largest displacement of the points that are followed [m]."""
    history = run.history
    after = history["stage"] == 1
    moved = np.max([np.hypot(history[f"{point}_ux"], history[f"{point}_uy"])[after] for point in POINTS], axis=0)
    return history["time"][after] - history["time"][after][0], moved


def growth(run):
    """Displacement in the second half of the time over that in the first [-]."""
    times, moved = motion(run)
    half = np.interp(times[-1] / 2, times, moved)
    return float(moved[-1] / half - 1)


def liveliness(run):
    """Kinetic energy at the end over its largest value since the strength counts [-]."""
    kinetic = run.history["kinetic"][run.history["stage"] == 1]
    return float(kinetic[-1] / np.max(kinetic))


class Search:
    """Bisection of the factor that separates slopes that hold from slopes that fail; `next()` asks for runs, `step()` waits and judges them."""

    def __init__(self, lab, data, name, soil, settings):
        self.lab, self.data, self.name, self.soil, self.settings = lab, data, name, soil, settings
        self.low, self.high = data["bracket"]
        self.pending, self.runs = [self.low, self.high], {}

    def next(self):
        """Starts the runs that are to be judged next."""
        for factor in self.pending:
            label = tools.label(f"{self.name}_{factor:g}")
            self.runs[factor] = self.lab.run(f"{CASE}/scene.yaml", label, {"materials[0]": reduced(self.data, self.soil, factor), **self.settings})

    def step(self, width):
        """Judges them; whether the bracket is still wider than `width`."""
        for factor in self.pending:
            if growth(self.runs[factor]) > self.data["growth"]:
                self.high = min(self.high, factor)
            else:
                self.low = max(self.low, factor)
        if not self.low < self.high or growth(self.runs[self.low]) > self.data["growth"] or growth(self.runs[self.high]) <= self.data["growth"]:
            raise ValueError(f"{self.name}: the factor of safety is not between {self.data['bracket']}, or not the only one")
        self.pending = [round((self.low + self.high) / 2, 6)]
        return self.high - self.low > width * 1.001

    @property
    def factor(self):
        """The middle of what is left."""
        return (self.low + self.high) / 2


def searched(lab, data, plan, width):
    """All searches of a plan [(name, soil, settings)] side by side."""
    searches = [Search(lab, data, *entry) for entry in plan]
    active = searches
    while active:
        for search in active:
            search.next()
        active = [search for search in active if search.step(width)]
    return searches


def draw(figure, searches, data):
    """Displacement over factor, and over time, of all trials."""
    axes = figure.subplots(1, 2)
    scale = data["constants"]["youngs_modulus"] / (data["unit weight [N/m^3]"] * data["height [m]"] ** 2)
    for mark, search in zip("o+x^sdv<>", searches):
        factors = sorted(search.runs)
        axes[0].plot(factors, [scale * motion(search.runs[factor])[1][-1] for factor in factors], f"{mark}-", fillstyle="none", label=search.name)
    reference, tolerance = data["factor of safety"], data["tolerance"]
    axes[0].axvspan(reference - tolerance, reference + tolerance, color="k", alpha=0.1, lw=0)
    axes[0].set(xlabel="factor F", ylabel="largest displacement E d / (gamma H$^2$) [-]", yscale="log")
    axes[0].legend()
    for factor, run in sorted(searches[0].runs.items()):
        times, moved = motion(run)
        axes[1].plot(times, moved, label=f"F = {factor:g}")
    axes[1].set(xlabel="time [s]", ylabel="largest displacement [m]", yscale="log", ylim=(1e-2, None))
    axes[1].legend()


def evaluate(lab):
    """Mohr-Coulomb and Drucker-Prager; at full level finer cells, and what the factor owes to choices that are ours."""
    data = tools.reference(CASE)
    full = lab.level == "full"
    sizes = [2, 1.5, 1] if full else [2]
    plan = [(f"{soil['law']}, cells of {size} m", soil, {"mesh.size": size}) for size in sizes for soil in data["soils"]]
    if full:
        plan += [(f"mohr_coulomb, cells of 2 m, {name}", data["soils"][0], {"mesh.size": 2, **settings}) for name, settings in (
            ("no damping", {"stages[1].damping": 0}), ("twice the time", {"stages[1].duration": 8}),
            ("volumes not averaged", {"bodies[0].f_bar": False}), ("flip", {"transfer.scheme": "flip"}))]
    results = []
    searches = searched(lab, data, plan, 0.025 if full else 0.05)
    for number, search in enumerate(searches):
        judged = number < len(sizes) * len(data["soils"])
        results.append(tools.Result(CASE, f"factor of safety, {search.name}", "-", search.factor, "near" if judged else "reported",
                                    data["tolerance"] if judged else None, data["factor of safety"], data["source"], search.runs[search.low]))
        if judged:
            for word, factor in (("holds", search.low), ("fails", search.high)):
                run = search.runs[factor]
                results += [tools.Result(CASE, f"{text}, F that {word}, {search.name}", "-", measure(run), "reported", None, None, "", run)
                            for text, measure in (("displacement of the second half over that of the first", growth),
                                                  ("kinetic energy at the end over its largest", liveliness))]
    lab.figure(CASE, "verification_factor_of_safety", lambda figure: draw(figure, searches[: len(sizes) * len(data["soils"])], data), size=(8.4, 3.6),
               caption="Displacement over the factor by which the strength is reduced (grey: reference and tolerance), and over time.")
    return results
