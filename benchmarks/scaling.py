#!/usr/bin/python3
"""What sharing a run costs: measures blocks on a few ranks (talus bench --mpi), fits a model to what ranks hold and send, works it out for many ranks.

Usage: benchmarks/scaling.py [--program build/talus] [--ranks 1,2,4,8] [--particles 50000,200000,400000] [--out runs/scaling] [--reuse] [--write-docs]
The tables go to the terminal, with --write-docs into docs/development/scaling.md; the figure is docs/images/scaling.png, or OUT/scaling.png.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys

import matplotlib.figure
import numpy as np
from lab import ROOT

PAGE, PICTURE = ROOT / "docs" / "development" / "scaling.md", ROOT / "docs" / "images" / "scaling.png"
MARKS = {name: (f"<!-- {name}: begin, written by benchmarks/scaling.py -->", f"<!-- {name}: end -->") for name in ("measured", "model", "predicted")}
SIMPLICES = {2: 2, 3: 6}  # cells that a square or a cube is cut into
BLOCK_CELLS = 128  # blocks of so many cells are shared out whole
PREDICTED = [100, 1_000, 10_000, 100_000]  # ranks
PARTICLES = 1_000_000_000
OTHERS = [10_000_000, 100_000_000, 1_000_000_000, 10_000_000_000]  # particles, in the figure


# ---- what is measured

def environment():
    """Open MPI refuses root, who runs things in containers, unless told; waiting threads must not take the cores of others."""
    told = {**os.environ, "OMP_WAIT_POLICY": "passive", "OMP_NUM_THREADS": "1"}
    if os.geteuid() == 0:
        told.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    return told


def measure(given, particles, ranks):
    """The results of one run of talus bench."""
    file = given.out / f"{particles}_on_{ranks}.json"
    if not (given.reuse and file.exists()):
        words = [str(given.program), "bench", "--mpi", "--particles", str(particles), "--steps", str(given.steps), "--repeats", str(given.repeats),
                 "--warm-up", str(given.warm_up), "--dimension", str(given.dimension), "--kernel", given.kernel, "--transfer", given.transfer,
                 "--json", str(file)]
        if ranks > 1:
            words = [given.mpiexec, "-n", str(ranks), *given.launch.split(), *words]
        done = subprocess.run(words, env=environment(), capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{' '.join(words)} ended with {done.returncode}:\n{done.stderr}")
    run = json.loads(file.read_text(encoding="utf-8"))
    print(f"{particles} particles on {ranks} ranks: {run['step [s]']['median'] * 1e3:.1f} ms a step", file=sys.stderr)
    return run


def most(run, key):
    """The largest value over the ranks."""
    return max(rank[key] for rank in run["ranks"])


def mean(run, key):
    return sum(rank[key] for rank in run["ranks"]) / len(run["ranks"])


# ---- parts of a box

def split(ranks, dimension):
    """The numbers of parts along each axis: factors of `ranks` with the smallest area between parts of a cube."""
    best = None
    for first in (p for p in range(1, ranks + 1) if ranks % p == 0):
        for rest in [(ranks // first,)] if dimension == 2 else [(q, ranks // first // q) for q in range(1, ranks // first + 1) if ranks // first % q == 0]:
            parts = (first, *rest)
            area = sum(p - 1 for p in parts)
            if best is None or (area, parts) < best:
                best = (area, parts)
    return best[1]


class Part:
    """The part of a rank with the largest number of neighbours, as a box; lengths in cubes (squares) of the mesh."""

    def __init__(self, whole, parts):
        self.whole = whole
        self.lengths = [whole / p for p in parts]
        self.sides = [min(p - 1, 2) for p in parts]  # with a neighbour, along each axis

    def area(self):
        """The area of the faces to other parts [faces of cubes]."""
        volume = math.prod(self.lengths)
        return sum(sides * volume / length for sides, length in zip(self.sides, self.lengths))

    def neighbours(self):
        """The number of neighbours across faces, edges and corners."""
        return math.prod(1 + sides for sides in self.sides) - 1

    def held(self, width):
        """The number of own cubes and of those in a layer of that width around, within the box."""
        return math.prod(min(self.whole, length + sides * width) for length, sides in zip(self.lengths, self.sides))


def part_of(run):
    dimension = run["setting"]["dimension"]
    return Part((run["cells"] / SIMPLICES[dimension]) ** (1 / dimension), split(len(run["ranks"]), dimension))


def inner_part(setting, particles, ranks):
    """A part with neighbours on all sides, as for very many ranks."""
    dimension = setting["dimension"]
    length = (particles / ranks / setting["per_cell"] / SIMPLICES[dimension]) ** (1 / dimension)
    return Part(length * ranks ** (1 / dimension), [max(3, ranks ** (1 / dimension))] * dimension) if ranks > 1 else Part(length, [1] * dimension)


# ---- the model

def slope(x, y):
    """The slope of a line through the origin by least squares."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    return float(x @ y / (x @ x)) if x @ x > 0 else 0.0


def line(x, y):
    """Slope and intercept of a line, neither below zero."""
    x, y = np.asarray(x, float), np.asarray(y, float)
    if np.ptp(x) > 0:
        a, b = np.polyfit(x, y, 1)
        if a >= 0 and b >= 0:
            return float(a), float(b)
        if a < 0:
            return 0.0, float(np.mean(y))
    return slope(x, y), 0.0


def fit(runs):
    """The parameters of the model from runs on one rank and on several."""
    alone = max((run for run in runs if len(run["ranks"]) == 1), key=lambda run: run["particles"])
    shared = [run for run in runs if len(run["ranks"]) > 1]
    setting = alone["setting"]
    cubes = SIMPLICES[setting["dimension"]]
    areas = [part_of(run).area() for run in shared]
    one = alone["ranks"][0]
    busy = one["cpu [s]"] / one["step [s]"]  # others may use the machine too
    widths = np.linspace(0, 40, 801)
    misfit = [sum(math.log(most(run, "cells_held") / (cubes * part_of(run).held(width))) ** 2 for run in shared) for width in widths]
    per_face, per_step = line(areas, [most(run, "bytes") for run in shared])
    grain = [BLOCK_CELLS * setting["per_cell"] * len(run["ranks"]) / run["particles"] for run in shared]
    return {"setting": setting,
            "particle": one["cpu [s]"] / alone["particles"],  # s of a step and particle
            "node": busy * one["nodes [s]"] / alone["nodes"],  # s of a step and node
            "shared": slope(areas, [most(run, "nodes_shared") for run in shared]),  # nodes to a face
            "bytes": per_face, "bytes_a_step": per_step,  # B to a face, and besides
            "messages": slope([part_of(run).neighbours() for run in shared], [most(run, "messages") for run in shared]),  # to a neighbour
            "collectives": float(np.mean([most(run, "collectives") for run in shared])),
            "collective_bytes": float(np.mean([most(run, "collective_bytes") for run in shared])),
            "width": float(widths[int(np.argmin(misfit))]),  # cubes
            "imbalance": max(0.0, slope(grain, [most(run, "particles") / mean(run, "particles") - 1 for run in shared])),
            "particle_bytes": one["particle_memory [B]"] / alone["particles"],
            "cell_bytes": (one["mesh_memory [B]"] + one["node_memory [B]"]) / alone["cells"]}


def predict(model, network, particles, ranks):
    """The model of a step of an inner rank: seconds by cause, bytes, messages, memory."""
    setting = model["setting"]
    part, own = inner_part(setting, particles, ranks), particles / ranks
    cubes = SIMPLICES[setting["dimension"]]
    bandwidth = network["bandwidth"] / network["ranks_a_node"]
    sent = (model["bytes"] * part.area() + model["bytes_a_step"]) if ranks > 1 else 0.0
    messages = model["messages"] * part.neighbours()
    cells = own / setting["per_cell"]
    held = max(cells, cubes * part.held(model["width"]))
    stages = math.log2(ranks) if ranks > 1 else 0.0
    seconds = {"particles": model["particle"] * own,
               "imbalance": model["particle"] * own * min(ranks - 1, model["imbalance"] * BLOCK_CELLS * setting["per_cell"] / own),
               "shared nodes": model["node"] * model["shared"] * part.area(),
               "bytes": sent / bandwidth,
               "messages": messages * network["latency"],
               "collectives": model["collectives"] * network["latency"] * stages + (2 * model["collective_bytes"] / bandwidth if ranks > 1 else 0.0)}
    step = sum(seconds.values())
    return {"ranks": ranks, "particles": own, "cells": cells, "held": held / cells, "bytes": sent, "messages": messages, "seconds": seconds, "step": step,
            "efficiency": seconds["particles"] / step, "memory": model["particle_bytes"] * own + model["cell_bytes"] * held}


# ---- tables and figure

def table(heads, rows):
    return "\n".join("| " + " | ".join(str(entry) for entry in entries) + " |" for entries in [heads, ["---"] * len(heads), *rows])


def count(number):
    return f"{number:,.0f}".replace(",", " ")


def measured_table(runs, model):
    alone = {run["particles"]: run["step [s]"]["median"] for run in runs if len(run["ranks"]) == 1}
    rows = []
    for run in runs:
        ranks, part = len(run["ranks"]), part_of(run)
        one, step = alone.get(run["particles"]), run["step [s]"]["median"]
        fair = ranks <= run["machine"]["cores"]
        held = most(run, "cells_held") / mean(run, "cells")
        modelled = model["bytes"] * part.area() + model["bytes_a_step"] if ranks > 1 else 0
        rows.append([count(run["particles"]), ranks, f"{step * 1e3:.1f}", f"{one / step / ranks * 100:.0f} %" if one and fair and ranks > 1 else "-",
                     f"{most(run, 'particles') / mean(run, 'particles'):.3f}", f"{held:.2f}",
                     f"{part.held(model['width']) * SIMPLICES[run['setting']['dimension']] / mean(run, 'cells'):.2f}" if ranks > 1 else "1.00",
                     f"{most(run, 'nodes_shared') / mean(run, 'nodes'):.3f}", f"{most(run, 'messages'):.1f}", f"{most(run, 'bytes') / 1e3:.0f}",
                     f"{modelled / 1e3:.0f}", f"{most(run, 'collectives'):.1f}", f"{most(run, 'collective_bytes') / 1e3:.1f}"])
    heads = ["particles", "ranks", "step [ms]", "efficiency", "imbalance", "cells held / own", "by the model", "nodes shared / own", "messages", "kB sent",
             "by the model", "collectives", "kB to all"]
    program, machine, setting = runs[0]["program"], runs[0]["machine"], runs[0]["setting"]
    return (f"Commit {program['commit']}, {machine['processor']} with {machine['cores']} cores; {setting['kernel']}, {setting['transfer']}, {setting['law']}, "
            f"{setting['dimension']}-D, {setting['per_cell']} particles a cell. Numbers of a step and of the rank that has most.\n\n" + table(heads, rows))


def model_table(model, network):
    rows = [["work of a particle", "c_p", f"{model['particle'] * 1e9:.0f} ns"], ["work of a node", "c_n", f"{model['node'] * 1e9:.0f} ns"],
            ["nodes shared, to a face between ranks", "s", f"{model['shared']:.2f}"], ["bytes sent, to a face between ranks", "a", f"{model['bytes']:.0f} B"],
            ["bytes sent besides", "b", f"{model['bytes_a_step'] / 1e3:.1f} kB"], ["messages to a neighbour", "m", f"{model['messages']:.1f}"],
            ["collectives", "C", f"{model['collectives']:.1f}"], ["bytes into them", "g", f"{model['collective_bytes'] / 1e3:.1f} kB"],
            ["width of the layer of cells held", "w", f"{model['width']:.1f} cubes"], ["imbalance, in blocks of 128 cells", "k", f"{model['imbalance']:.2f}"],
            ["memory of a particle", "", f"{model['particle_bytes']:.0f} B"], ["memory of a cell held, with its share of nodes", "", f"{model['cell_bytes']:.0f} B"],
            ["latency of a message (assumed)", "alpha", f"{network['latency'] * 1e6:g} us"],
            ["bandwidth of a node of the machine (assumed)", "beta", f"{network['bandwidth'] / 1e9:g} GB/s"],
            ["ranks on such a node (assumed)", "", network["ranks_a_node"]]]
    return table(["what", "", "value"], rows)


def predicted_table(predictions):
    rows = []
    for p in predictions:
        rows.append([count(p["ranks"]), count(p["particles"]), f"{p['held']:.2f}", f"{p['bytes'] / 1e6:.2f}", f"{p['messages']:.0f}",
                     *(f"{seconds * 1e3:.3g}" for seconds in p["seconds"].values()), f"{p['step'] * 1e3:.3g}", f"{p['efficiency'] * 100:.0f} %",
                     f"{p['memory'] / 1e6:.4g}"])
    heads = ["ranks", "particles a rank", "cells held / own", "MB sent", "messages", *(f"{reason} [ms]" for reason in predictions[0]["seconds"]), "step [ms]",
             "efficiency", "MB a rank"]
    return f"{count(PARTICLES)} particles; bytes, messages and times of a step.\n\n" + table(heads, rows)


def draw(model, network, file):
    """Draws the parts of the time of a step on the left, the efficiency for several sizes on the right."""
    figure = matplotlib.figure.Figure(figsize=(9, 3.6))
    left, right = figure.subplots(1, 2)
    ranks = np.unique(np.logspace(1.5, 5.5, 60).astype(int))  # enough for an inner rank
    curve = [predict(model, network, PARTICLES, int(r)) for r in ranks]
    for reason in curve[0]["seconds"]:
        left.loglog(ranks, [max(p["seconds"][reason], 1e-12) for p in curve], label=reason, linewidth=1)
    left.loglog(ranks, [p["step"] for p in curve], "k", label="step", linewidth=1.6)
    left.set(xlabel="ranks", ylabel="s of a step", ylim=(1e-7, None), title=f"{PARTICLES:.0e} particles".replace("e+0", "e").replace("e+", "e"))
    left.legend(fontsize=7)
    for particles in OTHERS:
        own = [int(r) for r in ranks if particles / r >= 1000]
        right.semilogx(own, [100 * predict(model, network, particles, r)["efficiency"] for r in own],
                       label=f"{particles:.0e} particles".replace("e+0", "e").replace("e+", "e"))
    right.set(xlabel="ranks", ylabel="efficiency [%]", ylim=(0, 105), title="extrapolated")
    right.legend(fontsize=7)
    figure.savefig(file, dpi=110)


def write_page(blocks):
    page = PAGE.read_text(encoding="utf-8")
    for name, text in blocks.items():
        begin, end = MARKS[name]
        head, rest = page.split(begin)
        page = f"{head}{begin}\n{text}\n{end}{rest.split(end)[1]}"
    PAGE.write_text(page, encoding="utf-8")


def whole_numbers(text):
    return [int(word) for word in text.split(",")]


def main():
    options = argparse.ArgumentParser(description="What sharing a run costs.")
    options.add_argument("--program", type=pathlib.Path, default=ROOT / "build/talus")
    options.add_argument("--mpiexec", default="mpirun")
    options.add_argument("--launch", default="--oversubscribe --bind-to none", help="options of mpiexec")
    options.add_argument("--ranks", type=whole_numbers, default=[1, 2, 4, 8], help="numbers of ranks; 1 is needed")
    options.add_argument("--particles", type=whole_numbers, default=[50_000, 200_000, 400_000])
    options.add_argument("--dimension", type=int, choices=(2, 3), default=3)
    options.add_argument("--kernel", default="projected")
    options.add_argument("--transfer", default="aflip")
    options.add_argument("--steps", type=int, default=3)
    options.add_argument("--repeats", type=int, default=3)
    options.add_argument("--warm-up", type=int, default=3)
    options.add_argument("--latency", type=float, default=1.5e-6, help="of a message [s]")
    options.add_argument("--bandwidth", type=float, default=12e9, help="of a node of the machine [B/s]")
    options.add_argument("--ranks-a-node", type=int, default=64)
    options.add_argument("--out", type=pathlib.Path, default=pathlib.Path("runs/scaling"))
    options.add_argument("--reuse", action="store_true", help="do not repeat runs whose files are there")
    options.add_argument("--write-docs", action="store_true", help="put tables and figure into docs/")
    given = options.parse_args()
    if 1 not in given.ranks or max(given.ranks) == 1:
        options.error("--ranks needs 1, and more")
    given.out.mkdir(parents=True, exist_ok=True)
    runs = [measure(given, particles, ranks) for particles in given.particles for ranks in sorted(given.ranks)]
    network = {"latency": given.latency, "bandwidth": given.bandwidth, "ranks_a_node": given.ranks_a_node}
    model = fit(runs)
    predictions = [predict(model, network, PARTICLES, ranks) for ranks in PREDICTED]
    blocks = {"measured": measured_table(runs, model), "model": model_table(model, network), "predicted": predicted_table(predictions)}
    draw(model, network, PICTURE if given.write_docs else given.out / "scaling.png")
    if given.write_docs:
        blocks["predicted"] += f"\n\n![Time of a step by reason, and efficiency, over ranks]({PICTURE.relative_to(PAGE.parent)})"
        write_page(blocks)
    else:
        print("\n\n".join(blocks.values()))


if __name__ == "__main__":
    main()
