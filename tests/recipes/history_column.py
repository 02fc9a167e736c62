"""A column of history.csv: one row in io/output/history_columns.hpp."""
import numpy as np

import talus
from recipe import BLOCK, Built, Recipe, Tree

ROW = """
      quantity<number>("drift", "m/s", "speed of the centre of mass", [](const auto& now) { return now.totals.momentum.norm() / now.totals.mass; }),"""


def apply(tree: Tree) -> None:
    behind = 'quantity<number>("mass", "kg", "mass of all particles", [](const auto& now) { return now.totals.mass; }),'
    tree.insert_behind(behind, "io/output/history_columns.hpp", ROW)


def works(built: Built) -> None:
    built.write("column.yaml", BLOCK + "  history: {every: 0.01}\n")
    built.run("run", "column.yaml", "--out", "column", "--quiet")
    history = talus.Run(built.folder / "column").history
    speed = np.hypot(history["momentum_x"], history["momentum_y"]) / history["mass"]
    np.testing.assert_allclose(history["drift"], speed, rtol=1e-12)
    assert history.units["drift"] == "m/s" and speed.min() > 0
    assert "speed of the centre of mass" in built.run("manual", "drift")
    built.write("twice.yaml", BLOCK + "  history: {every: 0.01, fronts: [{name: drift, direction: +x}]}\n")
    assert 'its column "drift" of history.csv is there already' in built.run("check", "twice.yaml", code=2)


RECIPE = Recipe(apply, works, most_files=1)
