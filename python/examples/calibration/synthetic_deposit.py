#!/usr/bin/python3
"""Observations of a deposit that was not measured but computed: scenes/deposit with other values than those in the file, and with errors of
measurement.  A calibration has to find these values again.

Usage: synthetic_deposit.py [--out DIR] [--errors SIZE] [--seed N]

Writes thickness.asc, outline.geojson, front.csv and top.csv, which scenes/deposit/calibration.yaml names.
"""
import argparse
import json
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "python"))  # not needed where the package is installed
import talus  # noqa: E402
from talus.calibration.outlines import contour_lines, resampled  # noqa: E402

SCENE = ROOT / "scenes/deposit/scene.yaml"
HIDDEN = {"materials[0].friction_angle": 26.0, "materials[0].cohesion": 150.0, "boundaries[0].coefficient": 0.35}
TIMES = np.arange(0.1, 1.01, 0.05)     # s
THRESHOLD, SPACING = 0.05, 0.05        # m: thickness of the rim, distance between its points
# Standard deviations [m] as in calibration.yaml
THICKNESS, RIM, FRONT, TOP = 0.01, 0.02, 0.01, 0.005


def observations(run, errors, seed):
    """{name of the file: text} of a run; errors: 1 for those of the stated size, 0 for none."""
    random = np.random.default_rng(seed)
    deposit = run.maps["thickness"]
    thickness = np.nan_to_num(deposit.values.astype(float))
    thickness += errors * THICKNESS * random.standard_normal(thickness.shape)
    rows = "\n".join(" ".join(f"{value:.5f}" for value in row) for row in thickness)
    west, _, south, _ = deposit.extent
    texts = {"thickness.asc": f"ncols {thickness.shape[1]}\nnrows {thickness.shape[0]}\nxllcorner {west:g}\nyllcorner {south:g}\n"
                              f"cellsize {deposit.cell[0]:g}\nNODATA_value -9999\n{rows}\n"}
    rim = resampled(contour_lines(deposit, THRESHOLD), SPACING)
    along = np.gradient(rim, axis=0)
    across = np.stack([along[:, 1], -along[:, 0]], axis=-1) / np.linalg.norm(along, axis=1)[:, None]
    rim += errors * RIM * random.standard_normal((len(rim), 1)) * across
    texts["outline.geojson"] = json.dumps({"type": "LineString", "coordinates": np.round(rim, 5).tolist()}) + "\n"
    for name, table, column, sigma in (("front", run.runout, "L", FRONT), ("top", run.history, "top_uz", TOP)):
        values = np.interp(TIMES, table["time"], table[column]) + errors * sigma * random.standard_normal(len(TIMES))
        lines = [f"{time:.2f},{value:.5f}" for time, value in zip(TIMES, values)]
        texts[f"{name}.csv"] = "\n".join([f"time [s],{column} [m]", *lines]) + "\n"
    return texts


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=Path, default=Path("."), help="folder of the files; default the present one")
    options.add_argument("--errors", type=float, default=1.0, help="over the standard deviations of calibration.yaml; default 1")
    options.add_argument("--seed", type=int, default=1)
    options = options.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        run = talus.run(SCENE, set=HIDDEN, out=Path(scratch) / "hidden")
        for name, text in observations(run, options.errors, options.seed).items():
            (options.out / name).write_text(text, encoding="utf-8")
            print(options.out / name)


if __name__ == "__main__":
    main()
