#!/usr/bin/python3
"""Tests of check_layers.py: what must pass and what must fail."""
import unittest

from check_layers import check_text


class Layers(unittest.TestCase):
    def passes(self, path, line):
        self.assertEqual(check_text(path, line), [])

    def fails(self, path, line):
        self.assertEqual(len(check_text(path, line)), 1, f"{line} in {path} was not noticed")

    def test_a_folder_sees_itself_and_what_is_below(self):
        self.passes("mesh/mesh.hpp", '#include "core/types.hpp"')
        self.passes("mesh/mesh.cpp", '#include "mesh/mesh.hpp"')
        self.passes("app/build.cpp", '#include "io/scene.hpp"')
        self.passes("tests/solver/advance_test.cpp", '#include "mesh/generate.hpp"')

    def test_a_folder_does_not_see_what_is_above_or_beside(self):
        self.fails("core/types.hpp", '#include "mesh/mesh.hpp"')
        self.fails("materials/law.hpp", '#include "mesh/mesh.hpp"')
        self.fails("io/scene.cpp", '#include "solver/model.hpp"')
        self.fails("tests/mesh/locate_test.cpp", '#include "kernels/kernel.hpp"')

    def test_what_the_tutorials_show_is_for_their_tests(self):
        self.passes("tests/tutorials/tutorials_test.cpp", '#include "docs/tutorials/own_law/maxwell.hpp"')
        self.fails("materials/laws.hpp", '#include "docs/tutorials/own_law/maxwell.hpp"')
        self.fails("tests/materials/law_test.cpp", '#include "docs/tutorials/own_law/maxwell.hpp"')

    def test_paths_start_at_the_root(self):
        self.fails("mesh/mesh.cpp", '#include "mesh.hpp"')
        self.fails("mesh/mesh.cpp", '#include "../core/types.hpp"')

    def test_a_third_party_header_has_one_file(self):
        for path, header in [("io/reader.cpp", "yaml-cpp/yaml.h"), ("io/gmsh_read.cpp", "gmsh.h"), ("io/vtk.cpp", "vtkNew.h"),
                             ("io/render_scene.cpp", "vtkNew.h"), ("io/report.cpp", "nlohmann/json.hpp"), ("app/cli.cpp", "CLI/CLI.hpp"),
                             ("app/expression.cpp", "muParser.h"), ("core/lanes.hpp", "immintrin.h"), ("core/exchange.cpp", "mpi.h"),
                             ("io/hdf5_disk.cpp", "hdf5.h"), ("mesh/partition.cpp", "metis.h")]:
            self.passes(path, f"#include <{header}>")
            self.fails("solver/run.hpp", f"#include <{header}>")
        self.passes("tests/io/report_test.cpp", "#include <nlohmann/json.hpp>")
        self.passes("tests/mesh/mesh_test.cpp", "#include <gtest/gtest.h>")
        self.fails("mesh/mesh.cpp", "#include <gtest/gtest.h>")
        self.fails("io/reader.hpp", "#include <yaml-cpp/yaml.h>")

    def test_unknown_libraries_are_noticed(self):
        self.fails("mesh/mesh.cpp", "#include <boost/array.hpp>")
        self.passes("mesh/mesh.cpp", "#include <vector>")
        self.passes("io/files.cpp", "#include <unistd.h>")
        self.passes("mesh/mesh.cpp", "#include <Eigen/LU>")

    def test_threads_have_one_file(self):
        self.passes("core/parallel.hpp", "#pragma omp parallel for")
        self.passes("solver/gather.hpp", "#pragma omp simd reduction(+ : sum)")
        self.fails("solver/gather.hpp", "#pragma omp parallel for")
        self.fails("solver/gather.hpp", '_Pragma("omp atomic")')
        self.fails("solver/gather.hpp", "#include <omp.h>")

    def test_findings_name_file_and_line(self):
        self.assertTrue(check_text("core/a.hpp", '\n#include "io/scene.hpp"')[0].startswith("core/a.hpp:2: "))


if __name__ == "__main__":
    unittest.main()
