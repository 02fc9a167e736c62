#!/usr/bin/python3
"""Which step of the differences suits a calibration?  Calibrates scenes/deposit with observations of hidden values that have no errors, with
differences over several shares of the range between the bounds.

Usage: calibration_steps.py [--out DIR] [--steps 0.005 0.02 ...]

Prints for each step the estimates over the hidden values and chi squared after at most 30 runs.  Takes a minute or two for each step.
"""
import argparse
import shutil
import sys
from pathlib import Path

import numpy as np
from synthetic_deposit import HIDDEN, SCENE, observations  # beside this file

import talus


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default=Path("runs/steps"))
    options.add_argument("--steps", type=float, nargs="+", default=[0.005, 0.02, 0.05, 0.1, 0.2])
    options = options.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    shutil.copy(SCENE, options.out)
    hidden = talus.run(SCENE, set=HIDDEN, out=options.out / "hidden", threads=1)
    for name, text in observations(hidden, 0.0, 1).items():
        (options.out / name).write_text(text, encoding="utf-8")
    plain = (SCENE.parent / "calibration.yaml").read_text(encoding="utf-8")
    for step in options.steps:
        specification = options.out / "calibration.yaml"
        specification.write_text(plain.replace("{start:", f"{{step: {step}, start:"), encoding="utf-8")
        result = talus.calibrate(specification, out=options.out / "runs", threads=1, pictures=False)
        ratios = " ".join(f"{one.value / HIDDEN[key]:.4f}" for key, one in result.estimates.items())
        chi2 = np.array(result.contents["chi2_of_steps"])
        print(f"step {step}: estimates over hidden values {ratios}, chi squared {chi2[-1]:.3g} after {result.contents['runs']['count']} runs; "
              f"second over first difference {np.round(result.contents['second_over_first_difference'], 2)}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
