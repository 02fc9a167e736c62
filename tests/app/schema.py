#!/usr/bin/python3
"""The JSON Schema of scenes takes every shipped scene and refuses those bad ones whose mistake it can see.

Usage: schema.py TALUS
"""
import json
import pathlib
import re
import subprocess
import sys

import jsonschema
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Of tests/io/bad_scenes: keys, words, types, ranges and lengths that are wrong, whatever else the scene says.
SEEN = """accuracy_misspelt bulk_viscosity_as_number cells_half cells_negative cfl_too_large checkpoint_unknown_key damping_one
dimension_four duration_zero empty_list f_bar_no_switch friction_angle_outside friction_missing friction_negative jitter_too_large
key_of_damage_missing list_for_mapping list_for_number mapping_for_list missing_block missing_key missing_title missing_type negative_density
number_for_list number_in_quotes on_exit_misspelt poisson_ratio_outside precision_taken_away radius_negative scheme_misspelt stage_without_duration
unknown_field unknown_kernel unknown_key unknown_key_in_shape unknown_key_of_law unknown_law unknown_load unknown_shape unknown_word
watch_policy_misspelt word_for_number yes_for_true zero_end""".split()


class Loader(yaml.SafeLoader):
    """YAML 1.2, as Talus and editors read it: 1.0e6 is a number, `on` and `yes` are words."""


Loader.yaml_implicit_resolvers = {}
for tag, pattern, first in [("bool", r"true|false", "tf"), ("int", r"[-+]?[0-9]+", "-+0123456789"), ("null", r"~|null|", ["~", "n", ""]),
                            ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", "-+.0123456789")]:
    Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), list(first))
Loader.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))


def load(file):
    return yaml.load(file.read_text(encoding="utf-8"), Loader)


def main():
    schema = json.loads(subprocess.run([sys.argv[1], "manual", "--schema"], check=True, capture_output=True, text=True).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    good = [*ROOT.glob("scenes/*/scene.yaml"), *ROOT.glob("benchmarks/*/scene*.yaml"), *ROOT.glob("tests/io/scenes/*.yaml")]
    assert len(good) > 20, good
    found = [f"{file}: {error.message[:200]}" for file in good for error in validator.iter_errors(load(file))]
    found += [f"{name} is not refused" for name in SEEN if validator.is_valid(load(ROOT / f"tests/io/bad_scenes/{name}.yaml"))]
    print("\n".join(found) if found else f"schema: {len(good)} scenes taken, {len(SEEN)} refused")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
