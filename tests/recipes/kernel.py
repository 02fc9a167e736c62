"""The kernel of docs/tutorials/own_kernel: one file, one line in kernels/kernels.hpp, one test."""
from recipe import SOURCE, Built, Recipe, Tree

PARTS = SOURCE / "docs/tutorials/own_kernel"


def apply(tree: Tree) -> None:
    tree.write("kernels/cell_mean.hpp", (PARTS / "cell_mean.hpp").read_text(encoding="utf-8"))
    tree.insert_behind("#pragma once\n", "kernels/kernels.hpp", '#include "kernels/cell_mean.hpp"\n')
    tree.insert_behind("using Kernels = TypeList<", "kernels/kernels.hpp", "CellMean<D>, ")
    tree.write("tests/kernels/cell_mean_test.cpp", (PARTS / "cell_mean_test.cpp").read_text(encoding="utf-8"))


def works(built: Built) -> None:
    built.run("--gtest_brief=1", "--gtest_filter=*Contract*:CellMean.*", program="talus_kernels_tests")
    built.run("run", SOURCE / "scenes/colliding_disks/scene.yaml", "--set", "kernel=cell_mean", "--out", "disks", "--quick", "--quiet")


RECIPE = Recipe(apply, works, most_files=2, test_targets=("talus_kernels_tests",))
