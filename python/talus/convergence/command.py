"""The command: python3 -m talus converge SCENE."""
from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import Any

from ..program import find_program
from . import describe, folder_of_study, plan_study, run_study
from .levels import Options, check_options
from .numbers import require_within


def add_converge(commands: Any) -> None:
    """Adds the command to a parser."""
    one = commands.add_parser("converge",
                              help="run a scene with cells of several sizes: order of convergence and uncertainty of its results",
                              description="Runs a scene with cells of several sizes.  Levels that are done in the folder are not repeated: "
                                          "the same command goes on.")
    one.add_argument("scene", type=Path, help="scene file (.yaml) whose mesh Talus makes")
    one.add_argument("--out", type=Path, metavar="DIR", help="folder of levels and table; default runs/<name of the scene>_convergence")
    one.add_argument("--ratio", type=float, default=math.sqrt(2), metavar="R",
                     help="size of cells over that of the next finer level; default sqrt(2)")
    for name, default, text in (("levels", 3, "how many; default 3"),
                                ("finer", 0, "how many of them have smaller cells than the scene; default 0: its cells and larger ones"),
                                ("jobs", None, "levels at a time; default 1, as the finest takes most of the time"),
                                ("threads", None, "threads of each; default as for a run, with --jobs the cores over that")):
        one.add_argument(f"--{name}", type=int, default=default, metavar="N", help=text)
    one.add_argument("--collect", action="append", default=[], metavar="A,B",
                     help="numbers, such as toe or max(kinetic); default all physical results")
    one.add_argument("--within", type=float, metavar="SHARE", help="status 1 unless each of --collect is within this share, such as 0.05")
    one.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="change a value of the scene")
    one.add_argument("--launcher", help="what each run is started by, such as \"mpirun -n 4\"")
    for name, text in (("list", "run nothing: tell the levels and how far they are"), ("json", "print convergence.json and nothing else"),
                       ("quick", "each level coarse and short: only to see that they run"), ("quiet", "no progress and no table")):
        one.add_argument(f"--{name}", action="store_true", help=text)
    one.add_argument("--program", type=Path, metavar="PATH", help="the program talus; default as in talus.find_program")
    one.set_defaults(run=_run, folder=_folder)


def _folder(words: argparse.Namespace) -> Path:
    return words.out if words.out is not None else folder_of_study(words.scene)


def _run(words: argparse.Namespace) -> int:
    is_quiet = words.quiet or words.json

    def tell(text: str) -> None:
        if not is_quiet or words.list:
            print(text, flush=True)

    def warn(text: str) -> None:
        print(f"warning: {text}", file=sys.stderr, flush=True)

    names = tuple(name for entry in words.collect for name in entry.split(","))
    options = Options(words.ratio, words.levels, words.finer, names, words.within, words.quick)
    check_options(options, words.jobs, words.threads)
    plan = plan_study(words.scene, words.set, _folder(words), options, find_program(words.program))
    tell(describe(plan))
    if words.list:
        for warning in plan.warnings:
            warn(warning)
        return 0
    numbers = run_study(plan, words.jobs, words.threads, words.launcher, tell, warn)
    if words.json and not words.quick:
        print((plan.folder / "convergence.json").read_text(encoding="utf-8"), end="", flush=True)
    if not is_quiet and any(not number.judged.is_told for number in numbers):
        print(f"smaller cells may help: --finer {words.finer + 1} goes on with the runs that are there", file=sys.stderr)
    require_within(words.within, numbers)
    return 0
