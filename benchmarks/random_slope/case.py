"""Probability that a slope of random clay fails, beside published results; statistics of the field that its particles have."""
import math

import numpy as np

import lab as tools

CASE = "random_slope"
VARIATION = "materials[0].variation[0]"


def normal(x):
    """The distribution function of the standard normal variable."""
    return (1 + math.erf(x / math.sqrt(2))) / 2


def probability_of_one_variable(deviation, data):
    """P(cu < 0.17 gamma H), cu being lognormal with the mean and coefficient of variation of the series."""
    spread = math.sqrt(math.log1p(deviation**2))
    return normal((spread**2 / 2 - math.log(data["factor of safety"])) / spread)


def start(lab, series, data):
    """The runs of a series, one a seed."""
    length = series["length [H]"] * data["height [m]"]
    finer = {"mesh.size": series["cells [m]"], **data["settings of finer cells"]} if "cells [m]" in series else {}
    name = "_".join(str(series[key]) for key in ("deviation", "length [H]", "cells [m]") if key in series)
    return {seed: lab.run(f"{CASE}/scene.yaml", tools.label(f"{name}_{seed}"),
                          {**finer, f"{VARIATION}.coefficient_of_variation": series["deviation"], f"{VARIATION}.correlation_length": [length],
                           f"{VARIATION}.seed": seed}, may_fail=True)
            for seed in range(1, series["seeds"] + 1)}


def fails(run, data):
    """Whether the slope of a run fails: it slides farther than slopes that stand, or the run ended early because it was torn apart."""
    return run.ending[0] != 0 or run.history["slid"][-1] > data["displacement that fails [m]"]


def share(count, n):
    """Share of n and its standard error, as of n + 2 with one more on each side, so that it is not 0 (Agresti & Coull 1998)."""
    p = (count + 1) / (n + 2)
    return count / n, math.sqrt(p * (1 - p) / (n + 2))


def probability(series, runs, data):
    """Result with the share of slopes that fail; of one variable judged within three standard errors."""
    p, error = share(sum(fails(run, data) for run in runs.values()), len(runs))
    name = f"V = {series['deviation']}, correlation length {series['length [H]']} H" + (f", cells of {series['cells [m]']} m" if "cells [m]" in series else "")
    expected = probability_of_one_variable(series["deviation"], data)
    judged = series.get("judged", False)
    return tools.Result(CASE, f"share of {len(runs)} slopes that fail, {name}, standard error {error:.2f}", "-", p, "near" if judged else "reported",
                        3 * error if judged else None, expected if judged else None, data["probability source"] if judged else "", runs[1])


def statistics(series, runs, data):
    """Mean and deviation of the logarithm of the factors of all particles and seeds, in units of their standard errors.

    A field of n seeds has about n A / (pi / 4 (length)^2) independent values, A being the area of the slope; at least n."""
    spread = math.sqrt(math.log1p(series["deviation"]**2))
    gaussian = np.array([np.log(run.frames[0]["yield_stress_factor"]) / spread + spread / 2 for run in runs.values() if run.ending[0] == 0])
    patch = np.pi / 4 * (series["length [H]"] * data["height [m]"])**2
    independent = len(gaussian) * max(1, 800 / patch)
    of_mean, of_deviation = gaussian.mean() * math.sqrt(independent), (gaussian.std() - 1) * math.sqrt(2 * independent)
    return [tools.Result(CASE, f"{name} of the Gaussian field over {len(gaussian)} seeds, in standard errors", "-", abs(float(value)), "at most", 3, 0,
                         "lognormal distribution of the scene", runs[1])
            for name, value in (("mean", of_mean), ("standard deviation", of_deviation))]


def draw(figure, started, data):
    """Share of failed slopes over the correlation length, and that of one variable."""
    axis = figure.subplots()
    for deviation, mark in ((0.25, "s"), (0.5, "o"), (1, "^")):
        points = sorted((series["length [H]"], *share(sum(fails(run, data) for run in runs.values()), len(runs))) for series, runs in started
                        if series["deviation"] == deviation and "cells [m]" not in series)
        if points:
            length, p, error = np.array(points).T
            axis.errorbar(np.minimum(length, 20), p, error, fmt=mark, capsize=3, label=f"talus, V = {deviation}")
            axis.axhline(probability_of_one_variable(deviation, data), ls=":", color=axis.lines[-1].get_color())
    axis.set(xscale="log", xlabel="correlation length over height (20: one variable)", ylabel="share of slopes that fail", ylim=(-0.02, 1))
    axis.legend()


def evaluate(lab):
    """Statistics of the field; shares of slopes that fail; the factor of safety of the mean."""
    data = tools.reference(CASE)
    started = [(series, start(lab, series, data)) for series in (data["series"] if lab.level == "full" else [data["quick"]])]
    uniform = lab.fos(f"{CASE}/scene.yaml", "uniform", {f"{VARIATION}.coefficient_of_variation": 1e-9, f"{VARIATION}.correlation_length": [10]},
                      **{"from": 1.3, "to": 1.6, "width": 0.05})
    results = [tools.Result(CASE, "factor of safety with the mean strength", "-", uniform.found["factor_of_safety"], "near", data["tolerance of the factor"],
                            data["factor of safety"], data["factor source"], uniform)]
    for series, runs in started:
        if series["length [H]"] < 100:
            results += statistics(series, runs, data)
        results.append(probability(series, runs, data))
    lab.figure(CASE, "verification_random_slope", lambda figure: draw(figure, started, data),
               caption="Share of slopes that fail; bars: standard error; dotted: one random variable for the whole slope.")
    return results
