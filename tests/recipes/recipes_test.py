#!/usr/bin/python3
"""Does what CONTRIBUTING.md tells for each extension in a copy of the tree, counts the files that it takes, builds the copy and uses the extension.

Usage: recipes_test.py CMAKE FOLDER [RECIPE...]     the copy and its build are kept in FOLDER, where a second call compiles only what has changed

A recipe is a module beside this one that has a RECIPE (recipe.py).  All of them are applied to one copy, so that it is built once.
"""
import importlib
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "python")]

from recipe import Built, Tree  # noqa: E402

NOT_RECIPES = {"recipe", "recipes_test"}


def is_source(path):
    return not path.startswith(("tests/", "docs/"))


def build(cmake, tree, folder, targets):
    """Without optimisation: the programs run little, and compile in half the time."""
    options = ["-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release", "-D", "CMAKE_CXX_FLAGS_RELEASE=-O0", "-D", "TALUS_UNITY=ON", "-D", "TALUS_WERROR=OFF"]
    for words in ([cmake, "-S", tree.root, "-B", folder, "-Wno-dev", *options],
                  [cmake, "--build", folder, "-j", os.environ.get("JOBS", str(os.cpu_count())), "--target", *targets]):
        done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode != 0:
            raise AssertionError(done.stdout[-6000:])


class Recipes(unittest.TestCase):
    def check(self, name, recipe, tree, built):
        sources = [path for path in tree.touched[name] if is_source(path)]
        with self.subTest(name, what="files"):
            self.assertLessEqual(len(sources), recipe.most_files, f"{name} takes {', '.join(sources)}")
        with self.subTest(name, what="works"):
            recipe.works(built)

    def test_every_extension_takes_few_files_and_works(self):
        tree = Tree(self.place / "tree")
        recipes = {name: importlib.import_module(name).RECIPE for name in self.names}
        for name, recipe in recipes.items():
            tree.begin(name)
            recipe.apply(tree)
            print(f"{name}: {len(tree.touched[name])} files: {', '.join(tree.touched[name])}", flush=True)
        tree.save()
        build(self.cmake, tree, self.place / "build", ["talus", *(target for recipe in recipes.values() for target in recipe.test_targets)])
        with tempfile.TemporaryDirectory() as folder:
            for name, recipe in recipes.items():
                self.check(name, recipe, tree, Built(self.place / "build", Path(folder)))


if __name__ == "__main__":
    Recipes.cmake, Recipes.place = sys.argv[1], Path(sys.argv[2]).resolve()
    Recipes.names = sys.argv[3:] or sorted(f.stem for f in HERE.glob("*.py") if f.stem not in NOT_RECIPES)
    unittest.main(argv=sys.argv[:1])
