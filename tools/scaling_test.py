#!/usr/bin/python3
"""Tests of what benchmarks/scaling.py works out; nothing is measured."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "benchmarks"))

import scaling  # noqa: E402

SETTING = {"dimension": 3, "per_cell": 8, "kernel": "projected", "transfer": "aflip", "law": "neo_hookean"}
NETWORK = {"latency": 1e-6, "bandwidth": 1e10, "ranks_a_node": 10}


def run(side, ranks, width=3.0):
    """A box of side^3 cubes as a machine that follows the model would measure it."""
    cells = 6 * side**3
    part = scaling.Part(side, scaling.split(ranks, 3))
    share = ranks > 1
    rank = {"particles": 8 * cells / ranks, "cells": cells / ranks, "cells_held": 6 * part.held(width), "nodes": side**3 / ranks,
            "nodes_shared": 2 * part.area(), "messages": 4 * part.neighbours(), "bytes": share * (100 * part.area() + 5000), "collectives": 5 * share,
            "collective_bytes": 1000 * share, "particle_memory [B]": 400 * 8 * cells / ranks, "mesh_memory [B]": 200 * 6 * part.held(width),
            "node_memory [B]": 100 * 6 * part.held(width), "nodes [s]": 2e-7 * side**3, "step [s]": 4e-7 * 8 * cells / ranks,
            "cpu [s]": 2e-7 * 8 * cells / ranks}
    return {"setting": SETTING, "cells": cells, "particles": 8 * cells, "nodes": side**3, "step [s]": {"median": 4e-7 * 8 * cells / ranks},
            "ranks": [rank] * ranks, "machine": {"processor": "x", "cores": 2}, "program": {"commit": "0"}}


class Geometry(unittest.TestCase):
    def test_parts_have_the_least_area_between_them(self):
        for ranks, dimension, parts in [(1, 3, (1, 1, 1)), (8, 3, (2, 2, 2)), (27, 3, (3, 3, 3)), (4, 2, (2, 2))]:
            self.assertEqual(scaling.split(ranks, dimension), parts)
        self.assertEqual(sorted(scaling.split(12, 3)), [2, 2, 3])

    def test_areas_neighbours_and_layers_are_those_of_boxes(self):
        half, inner = scaling.Part(10, (2, 1, 1)), scaling.Part(9, (3, 3, 3))
        self.assertEqual((half.area(), half.neighbours(), half.held(2)), (100, 1, 700))
        self.assertEqual((inner.area(), inner.neighbours(), inner.held(1), inner.held(100)), (54, 26, 125, 729))


class Model(unittest.TestCase):
    def setUp(self):
        self.runs = [run(side, ranks) for side in (12, 20) for ranks in (1, 2, 4, 8)]
        self.model = scaling.fit(self.runs)

    def test_finds_the_numbers_that_the_runs_were_made_of(self):
        for name, value in [("particle", 2e-7), ("node", 1e-7), ("shared", 2), ("bytes", 100), ("bytes_a_step", 5000), ("messages", 4), ("collectives", 5),
                            ("collective_bytes", 1000), ("width", 3), ("imbalance", 0), ("particle_bytes", 400), ("cell_bytes", 300)]:
            self.assertAlmostEqual(self.model[name] / (value or 1), 1 if value else 0, 6, name)

    def test_an_inner_rank_is_a_cube_with_neighbours_on_all_sides(self):
        told = scaling.predict(self.model, NETWORK, 1000 * 48 * 10**3, 1000)  # 10^3 cubes a rank
        self.assertAlmostEqual(told["bytes"], 100 * 600 + 5000, 3)
        self.assertAlmostEqual(told["messages"], 4 * 26, 6)
        self.assertAlmostEqual(told["held"], 16**3 / 10**3, 6)
        self.assertAlmostEqual(told["seconds"]["bytes"], 65000 / 1e9, 12)
        self.assertAlmostEqual(told["step"], sum(told["seconds"].values()), 12)

    def test_more_ranks_are_less_efficient_and_one_is_alone(self):
        shares = [scaling.predict(self.model, NETWORK, 10**9, ranks)["efficiency"] for ranks in (100, 1000, 10_000, 100_000)]
        self.assertEqual(shares, sorted(shares, reverse=True))
        alone = scaling.predict(self.model, NETWORK, 10**6, 1)
        self.assertEqual((alone["bytes"], alone["messages"], alone["held"]), (0, 0, 1))

    def test_tables_have_a_row_for_each_run_and_number_of_ranks(self):
        self.assertEqual(scaling.measured_table(self.runs, self.model).count("\n"), 2 + 1 + len(self.runs))
        predictions = [scaling.predict(self.model, NETWORK, scaling.PARTICLES, ranks) for ranks in scaling.PREDICTED]
        self.assertEqual(scaling.predicted_table(predictions).count("\n"), 2 + 1 + len(predictions))
        self.assertIn("| latency of a message (assumed) | alpha | 1 us |", scaling.model_table(self.model, NETWORK))

    def test_the_figure_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scaling.png"
            scaling.draw(self.model, NETWORK, file)
            self.assertGreater(file.stat().st_size, 10_000)


class Page(unittest.TestCase):
    def test_has_a_place_for_every_table(self):
        page = scaling.PAGE.read_text(encoding="utf-8")
        for begin, end in scaling.MARKS.values():
            self.assertEqual((page.count(begin), page.count(end)), (1, 1))


if __name__ == "__main__":
    unittest.main()
