#!/usr/bin/python3
"""Price of accuracy: sweeps mesh, particles per cell, kernel, transfer and time step of a case, draws error over processor time and memory.

Usage: talus tradeoff case [--level quick|full] [--out DIR]
Level quick takes every mesh with one of the other choices changed at a time, level full all combinations.
"""
import itertools
import json
import shutil

import verify  # first: it says which modules of Python are missing

import lab as tools
import numpy as np
import report

TARGETS = [0.1, 0.03, 0.01, 0.003, 0.001]
MOST_COLOURS = 10  # largest number of coloured lines; if there are more, only those on the front are coloured


def cases():
    """The cases with a sweep."""
    return [case for case in verify.CASES if (verify.SUITE / case / "case.py").exists() and "\ndef tradeoff(" in (verify.SUITE / case / "case.py").read_text(encoding="utf-8")]


def arguments():
    options = verify.parser(__doc__)
    options.add_argument("case", help=", ".join(cases()))
    given = options.parse_args()
    if given.case not in cases():
        options.error(f"no case {given.case} that can be swept; there are: {', '.join(cases())}")
    return verify.settle(options, given, "tradeoff")


def combinations(axes, everything):
    """Choices {axis: label}, one dictionary per run: the first axis in full, of the others one at a time away from its first label, or all."""
    product = [dict(zip(axes, labels)) for labels in itertools.product(*axes.values())]
    usual = {name: next(iter(labels)) for name, labels in axes.items()}
    others = list(axes)[1:]
    return [choice for choice in product if everything or sum(choice[name] != usual[name] for name in others) <= 1]


def front(points):
    """Indices of the Pareto-optimal points (cost, error), by cost: no other point is at least as good in both and better in one."""
    best, found = np.inf, []
    for i in sorted(range(len(points)), key=lambda i: points[i]):
        if points[i][1] < best:
            best = points[i][1]
            found.append(i)
    return found


def percent(share):
    return f"{share * 100:.3g} %"


def advice(points):
    """A sentence on the cheapest choice for each error of TARGETS, or on the smallest error if it is not reached; errors with the same choice share a sentence."""
    answers = []
    for target in TARGETS:
        reached = [p for p in points if p["error"] <= target]
        cheapest = min(reached, key=lambda p: p["processor_seconds"], default=None)
        if answers and answers[-1][1] is cheapest:
            answers[-1][0].append(target)
        else:
            answers.append(([target], cheapest))
    return [sentence(targets, point, points) for targets, point in answers]


def sentence(targets, point, points):
    """One line of advice."""
    shares = [f"{target * 100:g}" for target in targets]
    errors = f"{', '.join(shares[:-1])} or {shares[-1]} %" if len(shares) > 1 else f"{shares[0]} %"
    if point is None:
        best = min(points, key=lambda p: p["error"])
        return f"An error of {errors} is not reached; the smallest is {percent(best['error'])} with {best['name']} ({cost(best)})."
    return f"Cheapest for {errors} error: {point['name']} ({cost(point)}, error {percent(point['error'])})."


def cost(point):
    return f"{point['processor_seconds']:.3g} s, {point['peak_memory [B]'] / 1e6:.0f} MB"


def sweep(lab, case, description, everything):
    """Runs all combinations; returns points for completed runs and messages for failed ones."""
    chosen = combinations(description.axes, everything)
    asked = []
    for choice in chosen:
        settings = dict(description.settings)
        for axis, label in choice.items():
            settings.update(description.axes[axis][label])
        name = ", ".join(choice.values())
        asked.append((choice, name, lab.run(description.scene, tools.label(f"tradeoff_{name}"), settings)))
    points, failures = [], []
    for choice, name, run in asked:
        words = run.failure()
        error = None if words else tools.plain(description.error(run))
        if error is None:
            failures.append({"name": name, "error": words or "the error is not a finite number"})
        else:
            points.append({"name": name, "choice": choice, "error": error, "processor_seconds": run.seconds, "peak_memory [B]": run.memory,
                           "cells": run.cells, "particles": run.particles, "commit": run.summary["program"]["commit"]})
    return points, failures


def series(points, axes):
    """The points grouped by all axes except the first."""
    lines = {}
    for point in points:
        lines.setdefault(", ".join(point["choice"][name] for name in list(axes)[1:]), []).append(point)
    return lines


def draw(figure, points, axes, what):
    """Draws error over processor time on the left, over memory on the right, with the Pareto front as a line with rings."""
    rows = figure.add_gridspec(2, 2, height_ratios=[5, 1])
    left = figure.add_subplot(rows[0, 0])
    right = figure.add_subplot(rows[0, 1], sharey=left)
    lines, first = series(points, axes), next(iter(axes))
    for axis, price, scale, label in ((left, "processor_seconds", 1, "processor time [s]"), (right, "peak_memory [B]", 1e-6, "peak memory [MB]")):
        best = front([(p[price], p["error"]) for p in points])
        winners = {id(points[i]) for i in best}
        for name, own in lines.items():
            coloured = len(lines) <= MOST_COLOURS or any(id(p) in winners for p in own)
            style = {"label": name, "linewidth": 0.8} if coloured else {"color": "0.8", "linewidth": 0.5, "zorder": 1}
            axis.plot([p[price] * scale for p in own], [p["error"] * 100 for p in own], "o-", markersize=3, **style)
        axis.plot([points[i][price] * scale for i in best], [points[i]["error"] * 100 for i in best], "ko--", markersize=8, fillstyle="none", linewidth=0.8,
                  label="Pareto front")
        axis.set(xlabel=label, yscale="log")
    left.set(xscale="log", ylabel="error [%]")  # memory is mostly that of the program, so its range is less than a decade
    for axis in (left.xaxis, left.yaxis, right.yaxis):
        axis.set_major_formatter(lambda value, _: f"{value:g}")
        axis.set_minor_formatter(lambda value, _: f"{value:g}" if f"{value:e}"[0] in "25" else "")
    told = None
    for i in front([(p["processor_seconds"], p["error"]) for p in points]):
        if points[i]["choice"][first] != told:  # once for neighbouring points with the same label
            told = points[i]["choice"][first]
            left.annotate(told, (points[i]["processor_seconds"], points[i]["error"] * 100), textcoords="offset points", xytext=(7, 4), fontsize=7)
    figure.suptitle(what[0].upper() + what[1:], fontsize=10)
    handles, labels = left.get_legend_handles_labels()
    key = figure.add_subplot(rows[1, :])
    key.set_axis_off()
    key.legend(handles, labels, loc="center", ncols=2, fontsize=7)


def main():
    given = arguments()
    lab = tools.Lab(given.program, given.runs, given.out, given.level, given.reuse, given.threads, given.jobs)
    try:
        description = tools.module(given.case).tradeoff(lab)
        points, failures = sweep(lab, given.case, description, given.level == "full")
    finally:
        lab.close()
    for failure in failures:
        print(f"failed: {failure['name']}: {failure['error']}")
    if not points:
        return 1
    name = f"tradeoff_{given.case}"
    lab.figure(given.case, name, lambda figure: draw(figure, points, description.axes, description.what), size=(8, 4.6))
    words = advice(points)
    document = {"case": given.case, "what": description.what, "level": given.level, "threads": given.threads, "commit": points[0]["commit"], "figure": f"{name}.png",
                "advice": words, "front over processor time": [points[i]["name"] for i in front([(p["processor_seconds"], p["error"]) for p in points])],
                "front over memory": [points[i]["name"] for i in front([(p["peak_memory [B]"], p["error"]) for p in points])],
                "points": points, "failed": failures}
    path = given.out / f"{name}.json"
    path.write_text(json.dumps(document, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    if given.write_docs:
        shutil.copyfile(path, verify.SUITE / given.case / "tradeoff.json")
        shutil.copyfile(given.out / f"{name}.png", tools.ROOT / "docs/images" / f"{name}.png")
        report.write_documents(json.loads(report.RESULTS.read_text(encoding="utf-8")))
    print("\n".join([*words, str(path), str(given.out / f"{name}.png")]))
    return 0


if __name__ == "__main__":
    verify.end(main)
