"""A particle field and a node field: one row each in io/output/output_fields.hpp."""
import json

import numpy as np

import talus
from recipe import BLOCK, Built, Recipe, Tree

ROW = """
      quantity<number>("speed", "m/s", "length of the velocity", [](const auto& run, auto {row}) {{ return run.{values}.norm(); }}),"""


def apply(tree: Tree) -> None:
    file = "io/output/output_fields.hpp"
    for table, row, values in (("particle_fields", "p", "particles.v[p]"), ("node_fields", "n", "nodes.motion[n].v")):
        tree.insert_behind(f"constexpr auto {table}()\n{{\n  using enum QuantityKind;\n  return std::tuple{{", file, ROW.format(row=row, values=values))


def works(built: Built) -> None:
    outputs = "  particles: {every: 0.01, fields: [speed, velocity]}\n  mesh: {every: 0.01, fields: [speed, velocity]}\n"
    built.write("field.yaml", BLOCK + outputs)
    built.run("run", "field.yaml", "--out", "field", "--quiet")
    run = talus.Run(built.folder / "field")
    for file in (run.particles[-1], run.mesh_fields[-1]):
        np.testing.assert_allclose(file["speed"], np.linalg.norm(file["velocity"], axis=1), rtol=1e-6)
        assert file.units["speed"] == "m/s" and file["speed"].max() > 0
    assert "length of the velocity" in built.run("manual", "speed")
    outputs_of = json.loads(built.run("manual", "--schema"))["properties"]["outputs"]["properties"]
    items = [outputs_of[block]["properties"]["fields"]["items"] for block in ("particles", "mesh")]
    assert all("speed" in (words["anyOf"][0] if "anyOf" in words else words)["enum"] for words in items)
    built.write("misspelt.yaml", BLOCK + outputs.replace("[speed", "[sped"))
    told = built.run("check", "misspelt.yaml", code=2)
    assert 'misspelt.yaml:10:37: error: outputs.particles.fields[0]: there is no field "sped" — did you mean "speed"?' in told, told


RECIPE = Recipe(apply, works, most_files=1)
