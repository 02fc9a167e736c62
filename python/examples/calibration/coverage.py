#!/usr/bin/python3
"""How often does the stated uncertainty of a calibration contain the truth?  Calibrates scenes/deposit with observations of hidden values,
each time with other errors of measurement, and counts.

Usage: coverage.py [--out DIR] [--count N] [--method gauss_newton|ensemble] [--near]

Prints the estimates over the hidden values, and the number of intervals that contain these.  Takes a minute for each of N.
--near begins at values 5 % above the hidden ones.
"""
import argparse
import re
import shutil
import sys
from pathlib import Path

import numpy as np
from synthetic_deposit import HIDDEN, SCENE, observations  # beside this file

import talus


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default=Path("runs/coverage"))
    options.add_argument("--count", type=int, default=20)
    options.add_argument("--near", action="store_true")
    options.add_argument("--method", choices=("gauss_newton", "ensemble"), default="gauss_newton")
    options = options.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    for file in SCENE.parent.glob("*.yaml"):
        shutil.copy(file, options.out)
    specification = options.out / "calibration.yaml"
    text = specification.read_text(encoding="utf-8") + f"\nmethod: {options.method}\n"
    for key, value in HIDDEN.items() if options.near else ():
        text = re.sub(rf"({re.escape(key)}: {{start: )[^,]*", rf"\g<1>{1.05 * value:.6g}", text)
    specification.write_text(text, encoding="utf-8")
    hidden = talus.run(SCENE, set=HIDDEN, out=options.out / "hidden", threads=1)
    scaled, inside = [], []
    for seed in range(1, options.count + 1):
        for name, text in observations(hidden, 1.0, seed).items():
            (options.out / name).write_text(text, encoding="utf-8")
        result = talus.calibrate(specification, out=options.out / options.method, threads=1, pictures=False)
        scaled.append([(one.value - HIDDEN[key]) / one.deviation for key, one in result.estimates.items()])
        inside.append([one.low <= HIDDEN[key] <= one.high for key, one in result.estimates.items()])
        ratios = " ".join(f"{one.value / HIDDEN[key]:.4f} ± {one.deviation / HIDDEN[key]:.4f}" for key, one in result.estimates.items())
        print(f"seed {seed}: {ratios}, inside {inside[-1]}, chi squared {result.contents['chi2']:.1f} for "
              f"{result.contents['degrees_of_freedom']}, {result.contents['runs']['count']} runs, {result.contents['ending']}", flush=True)
    scaled, inside = np.array(scaled), np.array(inside)
    for k, key in enumerate(HIDDEN):
        print(f"{key}: {inside[:, k].sum()} of {len(inside)} intervals contain {HIDDEN[key]:g}; distance over deviation "
              f"{scaled[:, k].mean():.2f} in the mean, standard deviation {scaled[:, k].std(ddof=1):.2f}")


if __name__ == "__main__":
    sys.exit(main())
