"""The law of docs/tutorials/own_law: one file, one line in materials/laws.hpp, an example of its parameters, and one test."""
from recipe import SOURCE, Built, Recipe, Tree

PARTS = SOURCE / "docs/tutorials/own_law"


def apply(tree: Tree) -> None:
    tree.write("materials/maxwell.hpp", (PARTS / "maxwell.hpp").read_text(encoding="utf-8"))
    tree.insert_behind('#include "materials/johnson_cook.hpp"\n', "materials/laws.hpp", '#include "materials/maxwell.hpp"\n')
    tree.insert_behind("using Laws = TypeList<", "materials/laws.hpp", "\n    Maxwell,")
    tree.write("tests/materials/maxwell_test.cpp", (PARTS / "maxwell_test.cpp").read_text(encoding="utf-8"))
    example = (PARTS / "example.hpp").read_text(encoding="utf-8")
    tree.insert_behind("}  // namespace detail\n", "materials/law_examples.hpp", example[example.index("\ntemplate"):example.index("\n}  // namespace")])


def works(built: Built) -> None:
    built.run("--gtest_brief=1", "--gtest_filter=*Contract*:Maxwell.*", program="talus_materials_tests")
    built.run("drive", PARTS / "relax.yaml", "--out", "relax.csv")
    built.run("run", PARTS / "sag.yaml", "--out", "sag", "--quiet")
    assert "time in which the shear stress falls" in built.run("manual", "relaxation_time")


RECIPE = Recipe(apply, works, most_files=3, test_targets=("talus_materials_tests",))
