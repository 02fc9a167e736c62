#!/usr/bin/python3
"""Tests of the parts of the verification (benchmarks/*.py) that decide what is a pass and what is written where."""
import pathlib
import struct
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "benchmarks"))

import lab  # noqa: E402
import lz4.block  # noqa: E402
import numpy as np  # noqa: E402
import report  # noqa: E402
import vtp  # noqa: E402


def result(value, criterion, tolerance=None, reference=None):
    return lab.Result("case", "metric", "m", value, criterion, tolerance, reference, "source", None)


class Verdicts(unittest.TestCase):
    def test_each_criterion_accepts_its_bound_and_refuses_more(self):
        for criterion, tolerance, reference, good, bad in [("at most", 1, None, 1, 1.01), ("at least", 1, None, 1, 0.99), ("within", 0.25, -4, -5, -5.01),
                                                           ("near", 1, -4, -5, -5.01)]:
            self.assertIs(result(good, criterion, tolerance, reference).passed, True, criterion)
            self.assertIs(result(bad, criterion, tolerance, reference).passed, False, criterion)

    def test_a_number_that_is_not_finite_never_passes(self):
        self.assertIs(result(float("nan"), "at most", 1).passed, False)
        self.assertIs(result(float("inf"), "at least", 1).passed, False)

    def test_what_is_only_reported_has_no_verdict(self):
        self.assertIsNone(result(1, "reported").passed)


class Measures(unittest.TestCase):
    def test_the_order_of_a_parabola_is_two(self):
        self.assertAlmostEqual(lab.observed_order([1, 0.5, 0.25], [3, 0.75, 0.1875]), 2, places=12)

    def test_a_history_cut_short_loses_its_last_row_only(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "history.csv"
            path.write_text("time [s],kinetic [J]\n0,1\n0.5,2\n1,", encoding="utf-8")
            history = lab.read_history(path)
        self.assertEqual(history["time"].tolist(), [0, 0.5])
        self.assertEqual(history["kinetic"].tolist(), [1, 2])


class Readme(unittest.TestCase):
    def test_only_what_is_between_the_markers_is_replaced(self):
        text = f"before\n{report.BEGIN}\nold\n{report.END}\nafter\n"
        self.assertEqual(report.replace_block(text, "new"), f"before\n{report.BEGIN}\nnew\n{report.END}\nafter\n")

    def test_without_both_markers_in_order_nothing_is_replaced(self):
        for text in ("", report.BEGIN, f"{report.END}\n{report.BEGIN}", f"{report.BEGIN}{report.BEGIN}{report.END}"):
            self.assertIsNone(report.replace_block(text, "new"))


class ParticleFiles(unittest.TestCase):
    def write(self, folder, values, block):
        """A file with one array, in LZ4 blocks of `block` bytes."""
        raw = values.tobytes()
        parts = [raw[i:i + block] for i in range(0, len(raw), block)]
        packed = [lz4.block.compress(part, store_size=False) for part in parts]
        last = len(parts[-1]) if len(parts[-1]) < block else 0
        head = ('<VTKFile type="PolyData" header_type="UInt64" compressor="vtkLZ4DataCompressor"><PolyData><Piece><PointData/><Points>'
                '<DataArray type="Float64" Name="Points" NumberOfComponents="3" offset="0"/></Points></Piece></PolyData>'
                '<AppendedData encoding="raw">_')
        path = pathlib.Path(folder) / "p.vtp"
        path.write_bytes(head.encode() + struct.pack(f"<{3 + len(packed)}Q", len(parts), block, last, *map(len, packed)) + b"".join(packed))
        return path

    def test_arrays_come_back_whatever_the_last_block_holds(self):
        values = np.arange(60.0)
        with tempfile.TemporaryDirectory() as folder:
            for block in (48, 64, 480, 4096):
                points = vtp.read(self.write(folder, values, block))["Points"]
                np.testing.assert_array_equal(points, values.reshape(20, 3))

    def test_another_encoding_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "p.vtp"
            path.write_bytes(b"<VTKFile></VTKFile>")
            with self.assertRaises(ValueError):
                vtp.read(path)


if __name__ == "__main__":
    unittest.main()
