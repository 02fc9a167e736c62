#!/usr/bin/python3
"""Tests of what python/talus makes of results for others: pandas, xarray, Matplotlib, PyVista, notebooks; maps.

Usage: views_test.py PROGRAM, the built talus.  Tests of packages that are not installed are skipped; PyVista is a stand-in.
"""
import importlib
import os
import sys
import tempfile
import types
import unittest
from importlib.util import find_spec
from pathlib import Path
from unittest import mock

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import talus  # noqa: E402
from talus.plots import plane_of  # noqa: E402

SAND = {"name": "sand", "law": "drucker_prager", "density": 1600, "youngs_modulus": 1e6, "poisson_ratio": 0.3, "friction_angle": 30,
        "cohesion": 100, "match": "outer"}
FLAT = {
    "title": "Blocks <leave> & fall", "dimension": 2,
    "mesh": {"grid": {"low": [0, 0], "high": [2, 2], "cells": [8, 8]}},
    "materials": [SAND],
    "bodies": [{"name": "stays", "material": "sand", "shape": {"type": "box", "low": [0.25, 0.25], "high": [0.75, 0.75]}},
               {"name": "leaves", "material": "sand", "shape": {"type": "box", "low": [1.25, 1], "high": [1.75, 1.5]}, "velocity": [5, 0]}],
    "rigid": [{"name": "ball", "shape": {"type": "sphere", "centre": [1, 1.75], "radius": 0.15}, "mass": 10, "velocity": [0, 0.5]}],
    "on_exit": "delete", "time": {"end": 0.1},
    "outputs": {"particles": {"every": 0.02, "fields": ["velocity", "stress", "F"]}, "mesh": {"every": 0.05}, "history": {"every": 0.01}},
}
DEEP = {
    "title": "A heap", "dimension": 3,
    "mesh": {"grid": {"low": [0, 0, 0], "high": [4, 2, 2], "cells": [8, 4, 4]}},
    "materials": [SAND],
    "bodies": [{"name": "heap", "material": "sand", "shape": {"type": "box", "low": [0, 0, 0], "high": [1.5, 1.5, 1.5]}}],
    "loads": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
    "boundaries": [{"type": "fixed", "on": "z_min"}, {"type": "roller", "on": "x_min"}, {"type": "roller", "on": "y_min"}],
    "time": {"end": 0.1},
    "outputs": {"particles": {"every": 0.1}, "runout": {"every": 0.05, "moved": 0, "csv": True}},
}


def setUpModule():
    scratch = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(scratch.cleanup)
    OfRuns.folder = Path(scratch.name)
    OfRuns.flat, OfRuns.deep = (talus.run(scene, out=OfRuns.folder / name, threads=1) for name, scene in (("flat", FLAT), ("deep", DEEP)))


class OfRuns(unittest.TestCase):
    flat: talus.Run
    deep: talus.Run
    folder: Path

    def tearDown(self):
        plt.close("all")


@unittest.skipUnless(find_spec("pandas"), "python3-pandas is not installed")
class Pandas(OfRuns):
    def test_a_history_is_a_frame_with_units(self):
        history = self.flat.history
        frame = history.to_pandas("time")
        np.testing.assert_array_equal(frame["kinetic"].to_numpy(), history["kinetic"])
        self.assertEqual((frame.index.name, frame.attrs["units"]["kinetic"], list(history.to_pandas())), ("time", "J", list(history)))
        with self.assertRaisesRegex(talus.Missing, "did you mean time"):
            history.to_pandas("tim")

    def test_particles_are_a_row_each_with_a_column_for_each_component(self):
        last = self.deep.particles[-1]  # in 3-D, where no component is zero
        frame = last.to_pandas()
        self.assertEqual(frame.index.tolist(), last["id"].tolist())
        for column, pair in enumerate(("xx", "yy", "zz", "xy", "yz", "xz")):  # docs/guide/results.md
            np.testing.assert_array_equal(frame[f"stress_{pair}"].to_numpy(), last["stress"][:, column])
        self.assertEqual((frame.attrs["units"]["stress_xy"], frame.attrs["units"]["position_x"]), ("Pa", "m"))
        last = self.flat.particles[-1]
        np.testing.assert_array_equal(last.to_pandas()["F_yx"].to_numpy(), last["F"][:, 3])
        self.assertEqual(len(last.to_pandas("stays")), np.count_nonzero(last["body"] == 0))
        self.assertEqual(len(talus.to_pandas({"a": np.zeros(3), "stress": np.zeros((3, 4))}).columns), 5)


@unittest.skipUnless(find_spec("xarray"), "python3-xarray is not installed")
class Xarray(OfRuns):
    def test_particles_that_have_left_are_nan_in_a_series(self):
        series = self.flat.particles
        whole = series.to_xarray("velocity", "body")
        first, last = series[0], series[-1]
        self.assertEqual(dict(whole.sizes), {"time": len(series), "particle": len(first["id"]), "axis": 3})
        self.assertLess(len(last["id"]), len(first["id"]), "no particle has left")
        for frame, moment in zip(series, whole["velocity"]):
            np.testing.assert_array_equal(moment.sel(particle=frame["id"]).to_numpy(), frame["velocity"])
            gone = np.setdiff1d(first["id"], frame["id"])
            self.assertTrue(np.isnan(moment.sel(particle=gone)).all())
        self.assertEqual((whole["velocity"].attrs["units"], whole["time"].to_numpy().tolist()), ("m/s", series.times.tolist()))

    def test_one_file_and_a_mesh_are_datasets(self):
        last = self.flat.particles[-1].to_xarray()
        self.assertEqual((last["stress"].dims, last["F"].dims, last.attrs["time"]), (("particle", "component"), ("particle", "entry"), 0.1))
        np.testing.assert_array_equal(last["stress"].sel(component="xy"), self.flat.particles[-1]["stress"][:, 3])
        mesh, fields = self.flat.mesh, self.flat.mesh_fields
        whole = fields.to_xarray()
        self.assertEqual(whole["velocity"].shape, (len(fields), len(mesh.nodes), 3))
        np.testing.assert_array_equal(whole["velocity"][-1], fields[-1]["velocity"])
        np.testing.assert_array_equal(whole["nodes_of_cell"], mesh.cells)
        np.testing.assert_array_equal(whole["node_y"], mesh.nodes[:, 1])

    def test_tables_and_maps_are_arrays_with_coordinates(self):
        history = self.flat.history.to_xarray("time")
        self.assertEqual((history["kinetic"].dims, history["kinetic"].attrs["units"]), (("time",), "J"))
        self.assertEqual(self.flat.history.to_xarray()["time"].dims, ("row",))
        raster = self.deep.maps["thickness"]
        shown = raster.to_xarray()
        self.assertEqual((shown.dims, shown.name, shown.attrs["units"]), (("y", "x"), "thickness", "m"))
        self.assertEqual(float(shown.sel(x=0.25, y=0.25, method="nearest")), float(raster.values[-1, 0]))


class Maps(OfRuns):
    def test_every_map_has_the_values_of_its_table(self):
        maps = self.deep.maps
        self.assertIn("thickness", maps)
        for name, raster in maps.items():
            table = talus.Table(self.deep.folder / "maps" / f"{name}.csv")
            value, = (column for column in table if column not in ("x", "y"))
            x, y = table["x"], table["y"]
            column = np.abs(raster.x - x[:, None]).argmin(axis=1)
            row = np.abs(raster.y - y[:, None]).argmin(axis=1)
            np.testing.assert_allclose(raster.x[column], x, atol=1e-12)
            np.testing.assert_allclose(raster.y[row], y, atol=1e-12)
            np.testing.assert_array_equal(raster.values[row, column], table[value].astype("f4"), err_msg=name)
            self.assertEqual((raster.unit, np.isfinite(raster.values).sum()), (table.units[value], np.isfinite(table[value]).sum()), name)

    def test_a_map_knows_its_place_and_its_volume(self):
        raster = self.deep.maps["thickness"]
        self.assertAlmostEqual(np.nansum(raster.values) * raster.area / self.deep.runout["volume"][-1], 1, places=6)
        np.testing.assert_allclose(raster.extent, (0, 4, 0, 2), atol=1e-12)
        self.assertEqual((raster.axes, raster.crs, np.asarray(raster).shape), (("x", "y"), "", raster.values.shape))

    def test_maps_that_are_not_there_or_damaged_are_named(self):
        with self.assertRaisesRegex(talus.Missing, "no map thickness_x: did you mean thickness"):
            self.deep.maps["thickness_x"]
        with self.assertRaisesRegex(FileNotFoundError, "maps is not there: nothing has written maps"):
            self.flat.maps
        data = (self.deep.folder / "maps" / "thickness.tif").read_bytes()
        for name, wrong, kind in (("short.tif", data[:-20], talus.Damaged), ("head.tif", data[:90], talus.Damaged),
                                  ("text.tif", b"no map\n", talus.UnknownFormat)):
            path = self.folder / name
            path.write_bytes(wrong)
            with self.assertRaisesRegex(kind, name):
                talus.Raster(path)


class Pictures(OfRuns):
    def test_particles_are_drawn_where_they_are_with_their_values_and_sizes(self):
        first = self.flat.particles[0]
        axes = self.flat.plot("velocity", time=0, vmin=0, vmax=5)
        drawn, = axes.collections
        order = np.argsort(first["id"])
        place, speed = np.asarray(drawn.get_offsets()), np.asarray(drawn.get_array())
        self.assertEqual(sorted(map(tuple, place)), sorted(map(tuple, first["position"][order, :2])))
        self.assertEqual(set(speed[place[:, 0] > 1]), {5.0})
        self.assertEqual(set(speed[place[:, 0] < 1]), {0.0})
        self.assertEqual((drawn.get_clim(), axes.get_xlabel(), axes.get_title()), ((0, 5), "x [m]", "t = 0 s"))
        low, high = axes.get_xlim()
        self.assertTrue(low < 0.25 and high > 1.75)
        self.assertEqual(len(axes.figure.axes), 2, "no colour bar")

    def test_only_a_body_without_a_field_or_a_colour_bar(self):
        drawn, = self.flat.plot(time=0, body="leaves", color="red").collections
        self.assertTrue((np.asarray(drawn.get_offsets())[:, 0] > 1).all())
        self.assertIsNone(drawn.get_array())
        figure, axes = plt.subplots()
        self.assertIs(self.flat.plot("stress:xy", ax=axes, colorbar=False), axes)
        self.assertEqual(figure.axes, [axes])

    def test_in_3d_gravity_is_down_and_the_nearest_particle_on_top(self):
        axes = self.deep.plot("position:y")
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("x [m]", "z [m]"))
        place = np.asarray(axes.collections[0].get_offsets())
        last = self.deep.particles[-1]["position"]
        # seen against y with x to the right and z up: the smallest y is nearest, and drawn last
        self.assertEqual(sorted(zip(*place.T, axes.collections[0].get_array())), sorted((x, z, y) for x, y, z in last))
        depth = [last[(last[:, (0, 2)] == shown).all(axis=1), 1] for shown in (place[0], place[-1])]
        self.assertEqual((depth[0].max(), depth[1].min()), (last[:, 1].max(), last[:, 1].min()))
        for scene, dimension, plane in (("gravity", 2, "xy"), ("loads:\n- type: gravity\n  acceleration: [0, 0, -9.81]\n", 3, "xz"),
                                        ("{type: gravity, acceleration: [0, -9.81, 0]}", 3, "xy"),
                                        ("{type: gravity, acceleration: [a, b, c]}", 3, "xy")):
            self.assertEqual(plane_of(dimension, scene), plane)

    def test_values_of_fields_are_those_of_talus_render(self):
        stress = np.array([[3.0, 0, 0, 0, 0, 0], [0, 0, 0, 2, 0, 0]])
        np.testing.assert_allclose(talus.von_mises(stress), [3, 2 * np.sqrt(3)])
        last = self.flat.particles[-1]
        for name, wanted in (("pressure", -last["stress"][:, :3].mean(axis=1)), ("F:yx", last["F"][:, 3]),
                             ("velocity:x", last["velocity"][:, 0])):
            drawn = np.asarray(last.plot(name).collections[0].get_array())
            np.testing.assert_allclose(np.sort(drawn), np.sort(wanted), rtol=1e-6, err_msg=name)

    def test_a_mesh_shows_its_edges_and_its_fields(self):
        self.assertEqual(len(self.flat.plot(on="mesh").lines), 2)  # edges, and no markers
        axes = self.flat.plot("mass", on="mesh", time=0)
        np.testing.assert_array_equal(np.asarray(axes.collections[0].get_array()), self.flat.mesh_fields[0]["mass"].astype(float))
        with self.assertRaisesRegex(ValueError, "a mesh of tetrahedra"):
            self.deep.plot(on="mesh")

    def test_a_history_has_a_panel_for_each_unit(self):
        history = self.flat.history
        panels = history.plot("kinetic", "mass", "plastic")
        self.assertEqual([[line.get_label() for line in axes.lines] for axes in panels], [["kinetic", "plastic"], ["mass"]])
        np.testing.assert_array_equal(panels[1].lines[0].get_ydata(), history["mass"])
        energies = [line.get_label() for line in history.plot().lines]
        self.assertIn("kinetic", energies)
        self.assertNotIn("gravity work", energies)  # zero, without gravity

    def test_a_map_is_drawn_in_its_place(self):
        image, = self.deep.maps["thickness"].plot(cmap="magma").images
        np.testing.assert_allclose(image.get_extent(), (0, 4, 0, 2), atol=1e-12)
        self.assertEqual((image.origin, image.get_cmap().name), ("upper", "magma"))

    def test_what_cannot_be_drawn_is_named(self):
        for words, kind, given in (("did you mean velocity", talus.Missing, {"field": "velocty"}),
                                   ("no component of velocity xx", talus.Missing, {"field": "velocity:xx"}),
                                   ("name a component, such as F:xx", talus.Missing, {"field": "F"}),
                                   ("no body pile", talus.Missing, {"body": "pile"}),
                                   ("particles or mesh", ValueError, {"on": "cells"}),
                                   ("two different letters", ValueError, {"plane": "xx"})):
            with self.assertRaisesRegex(kind, words):
                self.flat.plot(**given)
        with self.assertRaisesRegex(FileNotFoundError, "outputs.mesh"):
            self.deep.plot("mass", on="mesh")
        with self.assertRaisesRegex(talus.Missing, "did you mean kinetic"):
            self.flat.history.plot("kinetik")


class Packages(OfRuns):
    def test_a_missing_package_is_named_with_its_debian_package(self):
        run = self.flat
        calls = {"pandas": (run.history.to_pandas, "python3-pandas"), "xarray": (run.particles.to_xarray, "python3-xarray"),
                 "pyvista": (run.to_pyvista, "pip install pyvista"), "matplotlib": (run.history.plot, "python3-matplotlib"),
                 "lz4": (lambda: run.particles[0]["id"], "python3-lz4"),
                 "h5py": (lambda: talus.Checkpoint(run.folder / "summary.json"), "python3-h5py")}
        for module, (call, package) in calls.items():
            there = importlib.import_module

            def without(name, gone=module):
                if name.partition(".")[0] == gone:
                    raise ModuleNotFoundError(f"No module named {gone!r}", name=gone)
                return there(name)
            with mock.patch("importlib.import_module", without), self.assertRaisesRegex(talus.MissingPackage, package) as caught:
                call()
            self.assertIsInstance(caught.exception, ImportError)

    def test_pyvista_gets_points_cells_and_fields(self):
        stand_in = types.ModuleType("pyvista")
        for name in ("PolyData", "UnstructuredGrid"):
            setattr(stand_in, name, lambda *given: types.SimpleNamespace(given=given, point_data={}, cell_data={}, field_data={}))
        stand_in.CellType = types.SimpleNamespace(TRIANGLE="triangle", TETRA="tetra")
        with mock.patch.dict(sys.modules, {"pyvista": stand_in}):
            cloud, grid, bare = self.flat.to_pyvista(time=0), self.flat.to_pyvista(on="mesh"), self.deep.to_pyvista(on="mesh")
            surface = self.flat.to_pyvista(on="rigid")
            with self.assertRaisesRegex(FileNotFoundError, "rigid bodies"):
                self.deep.to_pyvista(on="rigid")
        first, last = self.flat.particles[0], self.flat.mesh_fields[-1]
        np.testing.assert_array_equal(cloud.given[0], first["position"])
        np.testing.assert_array_equal(cloud.point_data["velocity"], first["velocity"])
        self.assertEqual((cloud.field_data["TimeValue"], "position" in cloud.point_data), ([0.0], False))
        np.testing.assert_array_equal(grid.given[0]["triangle"], last.cells)
        np.testing.assert_array_equal(grid.given[1], last.nodes)
        np.testing.assert_array_equal(grid.point_data["mass"], last["mass"])
        self.assertEqual((list(bare.given[0]), bare.point_data), (["tetra"], {}))
        middle = surface.given[1].mean(axis=0)
        np.testing.assert_allclose(middle[:2], (1, 1.75 + 0.5 * 0.1), atol=0.01)
        np.testing.assert_allclose(surface.point_data["velocity"], np.broadcast_to((0, 0.5, 0), (len(surface.given[1]), 3)), atol=1e-6)


class Notebooks(OfRuns):
    def test_a_run_shows_its_state_and_is_safe(self):
        shown = self.flat._repr_html_()
        for words in ("Blocks &lt;leave&gt; &amp; fall", "<b>done</b>", "stays", f"particles ({len(self.flat.particles)})",
                      f"history ({self.flat.history.rows})"):
            self.assertIn(words, shown)
        self.assertNotIn("<leave>", shown)
        for warning in self.flat.warnings:
            self.assertIn(warning[:20], shown)
        self.assertIn("flat: done", repr(self.flat))

    def test_a_table_shows_units_and_both_ends(self):
        history = self.flat.history
        shown = history._repr_html_()
        self.assertIn("<th>kinetic<br>[J]</th>", shown)
        self.assertIn(f"{history['kinetic'][-1]:.6g}", shown)
        self.assertIn(f"{history.rows} rows, {len(history)} columns", shown)

    def test_a_folder_without_results_is_refused_and_a_damaged_one_shown(self):
        empty = self.folder / "empty"
        empty.mkdir()
        with self.assertRaisesRegex(FileNotFoundError, "empty holds no results of a run"):
            talus.open(empty)
        (empty / "summary.json").write_text("{", encoding="utf-8")
        self.assertIn("summary.json", talus.open(empty)._repr_html_())


if __name__ == "__main__":
    os.environ["TALUS"] = str(Path(sys.argv.pop(1)).absolute())
    unittest.main()
