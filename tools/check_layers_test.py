#!/usr/bin/python3
"""Tests of check_layers.py: what must pass and what must fail."""
import pathlib
import tempfile
import unittest

from check_layers import FOLDERS, MOST_LINES, check_folders, check_length, check_text, circle_in, written_files


class Layers(unittest.TestCase):
    def passes(self, path, line):
        self.assertEqual(check_text(path, line), [])

    def fails(self, path, line):
        self.assertEqual(len(check_text(path, line)), 1, f"{line} in {path} was not noticed")

    def test_a_folder_sees_itself_and_what_is_below(self):
        self.passes("mesh/mesh.hpp", '#include "core/types.hpp"')
        self.passes("mesh/mesh.cpp", '#include "mesh/mesh.hpp"')
        self.passes("app/setup/setup.cpp", '#include "io/scene/scene.hpp"')
        self.passes("tests/solver/advance_test.cpp", '#include "mesh/generate/generate.hpp"')

    def test_a_folder_does_not_see_what_is_above_or_beside(self):
        self.fails("core/types.hpp", '#include "mesh/mesh.hpp"')
        self.fails("materials/parts/law.hpp", '#include "mesh/mesh.hpp"')
        self.fails("io/scene/scene.cpp", '#include "solver/model/model.hpp"')
        self.fails("io/document/document.cpp", '#include "io/scene/scene.hpp"')
        self.fails("app/setup/setup.cpp", '#include "app/cli/cli.hpp"')
        self.fails("tests/mesh/locate_test.cpp", '#include "kernels/kernel.hpp"')

    def test_what_the_tutorials_show_is_for_their_tests(self):
        self.passes("tests/tutorials/tutorials_test.cpp", '#include "docs/tutorials/own_law/maxwell.hpp"')
        self.fails("materials/laws.hpp", '#include "docs/tutorials/own_law/maxwell.hpp"')
        self.fails("tests/materials/law_test.cpp", '#include "docs/tutorials/own_law/maxwell.hpp"')

    def test_paths_start_at_the_root(self):
        self.fails("mesh/mesh.cpp", '#include "mesh.hpp"')
        self.fails("mesh/mesh.cpp", '#include "../core/types.hpp"')

    def test_a_third_party_header_has_one_file(self):
        for path, header in [("io/scene/reader.cpp", "yaml-cpp/yaml.h"), ("io/mesh/gmsh_read.cpp", "gmsh.h"), ("io/output/vtk.cpp", "vtkNew.h"),
                             ("io/pictures/render_scene.cpp", "vtkNew.h"), ("io/output/run_summary.cpp", "nlohmann/json.hpp"), ("app/cli/cli.cpp", "CLI/CLI.hpp"),
                             ("app/setup/expression.cpp", "muParser.h"), ("core/simd.hpp", "immintrin.h"), ("core/parallel/mpi_calls.hpp", "mpi.h"),
                             ("io/checkpoint/hdf5_disk.cpp", "hdf5.h"), ("mesh/partition.cpp", "metis.h")]:
            self.passes(path, f"#include <{header}>")
            self.fails("solver/stages.hpp", f"#include <{header}>")
        self.passes("tests/io/output/run_summary_test.cpp", "#include <nlohmann/json.hpp>")
        self.passes("tests/mesh/mesh_test.cpp", "#include <gtest/gtest.h>")
        self.fails("mesh/mesh.cpp", "#include <gtest/gtest.h>")
        self.fails("io/scene/reader.hpp", "#include <yaml-cpp/yaml.h>")

    def test_unknown_libraries_are_noticed(self):
        self.fails("mesh/mesh.cpp", "#include <boost/array.hpp>")
        self.passes("mesh/mesh.cpp", "#include <vector>")
        self.passes("io/files/atomic_file.cpp", "#include <unistd.h>")
        self.passes("mesh/mesh.cpp", "#include <Eigen/LU>")

    def test_threads_have_one_file(self):
        self.passes("core/parallel/threads.hpp", "#pragma omp parallel for")
        self.passes("solver/transfer/sweep.hpp", "#pragma omp simd reduction(+ : sum)")
        self.fails("solver/transfer/sweep.hpp", "#pragma omp parallel for")
        self.fails("solver/transfer/sweep.hpp", '_Pragma("omp atomic")')
        self.fails("solver/transfer/sweep.hpp", "#include <omp.h>")

    def test_folders_include_each_other_in_no_circle(self):
        self.assertEqual(circle_in(FOLDERS), [])
        self.assertEqual(circle_in({"a": ["b"], "b": ["c"], "c": ["b"]}), ["b", "c", "b"])

    def test_a_folder_has_a_readme_few_files_and_names_of_its_own(self):
        table = {"core": [], "mesh": ["core"]}
        self.assertEqual(check_folders(table, ["core/a.hpp", "mesh/b.hpp", "tests/mesh/a.hpp"]), [])
        self.assertIn("the same name twice", check_folders(table, ["core/a.hpp", "mesh/a.hpp"])[0])
        self.assertIn("no README.md", check_folders(table, ["core/a.hpp", "mesh/b.hpp", "mesh/generate/c.hpp"])[0])
        self.assertIn("41 source files", check_folders(table, ["mesh/b.hpp", *(f"core/a{n}.hpp" for n in range(41))])[0])
        self.assertIn("no folder core", check_folders({"mesh": ["core"]}, ["mesh/b.hpp"])[0])

    def test_a_source_file_has_no_more_than_400_lines(self):
        self.assertEqual(check_length("core/a.cpp", "\n" * MOST_LINES), [])
        self.assertEqual(check_length("core/a.cpp", "\n" * (MOST_LINES + 1)),
                         ["core/a.cpp: 401 lines, more than 400: give each duty a file of its own"])

    def test_the_length_of_sources_in_every_language_is_looked_at(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("core/a.cpp", "page/test/b.mjs", "python/c.py", "build/d.py", "page/node_modules/e.js", "docs/f.md"):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).touch()
            self.assertEqual([f.relative_to(root).as_posix() for f in written_files(root)], ["core/a.cpp", "page/test/b.mjs", "python/c.py"])

    def test_findings_name_file_and_line(self):
        self.assertTrue(check_text("core/a.hpp", '\n#include "io/scene/scene.hpp"')[0].startswith("core/a.hpp:2: "))


if __name__ == "__main__":
    unittest.main()
