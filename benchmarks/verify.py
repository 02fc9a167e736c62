#!/usr/bin/python3
"""Runs the benchmarks with a built talus and writes results.json, docs/verification.md with its figures, and the block in README.md.

Usage: tools/verify.sh [case ...] [--level quick|full] [--reuse]      without cases: all of them, and the reports are written
"""
import argparse
import importlib.util
import pathlib
import sys
import time

import lab as tools
import report

CASES = ["vibrating_bar", "irregular_bar", "self_weight_column", "sliding_block", "colliding_disks", "cantilever", "slope_failure_2d",
         "shock", "taylor_bar", "cook_membrane"]


def load(case):
    """The module case.py of a benchmark."""
    spec = importlib.util.spec_from_file_location(f"case_{case}", tools.ROOT / "benchmarks" / case / "case.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="case", help=", ".join(CASES))
    parser.add_argument("--level", choices=["quick", "full"], default="quick")
    parser.add_argument("--reuse", action="store_true", help="do not repeat runs whose program and inputs are unchanged")
    parser.add_argument("--program", type=pathlib.Path, default=tools.ROOT / "build/talus")
    parser.add_argument("--runs", type=pathlib.Path, default=tools.ROOT / "runs/verify")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    if unknown := [case for case in given.cases if case not in CASES]:
        parser.error(f"no case {', '.join(unknown)}; there are: {', '.join(CASES)}")
    if not given.program.exists():
        parser.error(f"{given.program} is not there: make build")
    return given


def main():
    given = arguments()
    everything = not given.cases
    images = tools.ROOT / "docs/images" if everything else given.runs
    lab = tools.Lab(given.program, given.runs, images, given.level, given.reuse, given.threads)
    results = []
    for case in given.cases or CASES:
        start = time.monotonic()
        print(f"{case}:", flush=True)
        own = load(case).evaluate(lab)
        results += own
        for result in own:
            print("  " + report.line(result))
        print(f"  {time.monotonic() - start:.0f} s")
    if everything:
        report.write(results, lab)
    failed = [result for result in results if result.passed is False]
    print(f"{len(results)} results, {sum(result.passed is True for result in results)} passed, {len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
