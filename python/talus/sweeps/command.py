"""The command talus sweep."""
from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from . import default_folder, list_cases, sweep


def add_sweep(commands: Any, whole: Any) -> None:
    """Adds the command to others.

    whole  reads a word as a whole number from 1
    """
    one = commands.add_parser("sweep", help="run a scene with several values of its keys, and put their results into a table",
                              description="Runs a scene with several values of its keys, and puts their results into a table.  Cases that "
                                          "are done are not repeated: the same command goes on.")
    one.add_argument("file", metavar="study", type=Path, help="study (.yaml): scene, what varies, what the table collects")
    one.add_argument("--out", type=Path, metavar="DIR", help="folder of cases and table; default runs/<name of the study>")
    one.add_argument("--jobs", type=whole, metavar="N", help="cases at a time; default as many as there are cores for")
    one.add_argument("--threads", type=whole, metavar="N", help="threads of each; default the cores over the cases at a time")
    one.add_argument("--case", type=int, metavar="K", help="run this case alone, counted from 1: for the jobs of an array")
    one.add_argument("--launcher", metavar="WORDS", help='what each run is started by, such as "mpirun -n 4"')
    one.add_argument("--list", action="store_true", help="run nothing: tell the cases and how far they are, bring the table up to date")
    one.add_argument("--no-pictures", dest="pictures", action="store_false", help="draw nothing")
    one.add_argument("--quick", action="store_true", help="each case coarse and short: only to see that they run")
    one.add_argument("--quiet", action="store_true", help="no progress and no table")
    one.add_argument("--program", type=Path, metavar="PATH", help="the program talus; default as in talus.find_program")
    one.set_defaults(run=_run, folder=lambda options: options.out if options.out is not None else default_folder(options.file))


def _run(options: argparse.Namespace) -> int:
    def tell(text: str) -> None:
        if not options.quiet or options.list:
            print(text, flush=True)

    def warn(text: str) -> None:
        print(f"warning: {text}", file=sys.stderr, flush=True)

    if options.list:
        list_cases(options.file, out=options.out, quick=options.quick, tell=tell, warn=warn, program=options.program)
    else:
        sweep(options.file, out=options.out, jobs=options.jobs, threads=options.threads, case=options.case, launcher=options.launcher,
              quick=options.quick, pictures=options.pictures, tell=tell, warn=warn, program=options.program)
    return 0
