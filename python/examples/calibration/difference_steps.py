#!/usr/bin/python3
"""Which step of the differences suits a calibration?  Calibrates scenes/deposit with observations of hidden values without errors, with
differences over several shares of the range between the bounds.

Usage: difference_steps.py [--out DIR] [--steps 0.005 0.02 ...]
       difference_steps.py --scatter [--out DIR]

Prints for each step the estimates over the hidden values and chi squared after at most 30 runs.  Takes a minute or two for each step.
--scatter prints how far derivatives by the friction angle are from those with a step of a tenth of it, for the column in two dimensions of
../gallery/friction_study.py: thickness of the deposit, position of its front, and that of its centre over time.
"""
import argparse
import shutil
import sys
from pathlib import Path

import numpy as np
from synthetic_deposit import HIDDEN, SCENE, observations  # beside this file

import talus

SHARES = (0.003, 0.01, 0.02, 0.05, 0.1, 0.2)  # of the friction angle


def scatter(out):
    """Distances of derivatives from those with a step of a tenth of the friction angle, over the length of these."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "gallery"))
    from friction_study import SCENE as column
    times, angle = np.arange(0.1, 1, 0.05), 26.0

    def results(share):
        run = talus.run({**column, "outputs": {**column["outputs"], "runout": {"every": 0.02, "moved": 0}}}, out=out / f"share_{share:g}",
                        set={"materials[0].friction_angle": angle * (1 + share), "materials[0].cohesion": 150.0}, threads=1)
        return {"thickness": np.nan_to_num(run.section("plane")["thickness"]),
                **{name: np.interp(times, run.runout["time"], run.runout[name]) for name in ("L", "centre_L")}}
    slopes = {}
    for share in SHARES:
        up, down = results(share), results(-share)
        slopes[share] = {name: (up[name] - down[name]) / (2 * share) for name in up}
    for share in SHARES:
        far = {name: np.linalg.norm(slope - slopes[0.1][name]) / np.linalg.norm(slopes[0.1][name])
               for name, slope in slopes[share].items()}
        print(f"step of {100 * share:g} % of the angle: " + ", ".join(f"{name} {value:.2f}" for name, value in far.items()))


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default=Path("runs/steps"))
    options.add_argument("--steps", type=float, nargs="+", default=[0.005, 0.02, 0.05, 0.1, 0.2])
    options.add_argument("--scatter", action="store_true")
    options = options.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    if options.scatter:
        scatter(options.out)
        return
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
