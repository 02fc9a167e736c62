"""The command: python3 -m talus fos SCENE."""
from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from ..program import find_program
from . import folder_of_search, search_in
from .plan import RUN, STATIC, Options
from .search import Range


def add_fos(commands: Any) -> None:
    """Adds the command to a parser."""
    one = commands.add_parser("fos", help="find by how much the strength of a scene can be divided before it fails",
                              description="Finds the factor of safety of a scene.  Trials that are done in the folder are not repeated: "
                                          "the same command goes on.")
    one.add_argument("scene", type=Path, help="scene file (.yaml) with a geostatic or static stage")
    one.add_argument("--out", type=Path, metavar="DIR", help="folder of trials and table; default runs/<name of the scene>_fos")
    for name, default, text in (("from", 0.5, "lowest factor that is tried first; default 0.5"),
                                ("to", 3.0, "highest factor that is tried first; default 3"),
                                ("width", 0.02, "how close holding and failing factors come; default 0.02"),
                                ("duration", None, "of a run [s]; default 3 sqrt(height / gravity), or 20 passes of waves if longer"),
                                ("damping", None, "local damping of a run; default 0.3"),
                                ("growth", 0.1, "moved in the second half of a trial over the first, above which it fails; default 0.1"),
                                ("kinetic", None, "of a run: kinetic energy at the end over its peak, above which it fails; default 5e-4"),
                                ("steadiness", None, "of a static trial: moved in its last third over the middle third, above which it "
                                                     "fails; default 0.5"),
                                ("share", 0.99, "displacement that this share of the mass does not exceed is looked at; default 0.99")):
        one.add_argument(f"--{name}", type=float, default=default, metavar="X", help=text)
    one.add_argument("--trials", choices=(RUN, STATIC), help="default as the stage that finds the state at rest")
    for name, text in (("increments", "of a static trial; default 6"), ("jobs", "trials at a time; default one a core, up to 4"),
                       ("threads", "threads of each; default the cores over the trials at a time")):
        one.add_argument(f"--{name}", type=int, metavar="N", help=text)
    one.add_argument("--bodies", action="append", default=[], metavar="A,B", help="whose strength is divided; default all that have some")
    one.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="change a value of the scene")
    one.add_argument("--launcher", help="what each run is started by, such as \"mpirun -n 4\"")
    one.add_argument("--no-pictures", dest="pictures", action="store_false", help="draw nothing")
    one.add_argument("--quick", action="store_true", help="each run coarse and short: only to see that they run")
    one.add_argument("--quiet", action="store_true", help="only the factor")
    one.add_argument("--program", type=Path, metavar="PATH", help="the program talus; default as in talus.find_program")
    one.set_defaults(run=_run, folder=_folder)


def _folder(words: argparse.Namespace) -> Path:
    return words.out if words.out is not None else folder_of_search(words.scene)


def _run(words: argparse.Namespace) -> int:
    names = tuple(name for entry in words.bodies for name in entry.split(","))
    options = Options(Range(getattr(words, "from"), words.to, words.width), words.trials, words.duration, words.damping, words.increments,
                      words.growth, words.kinetic, words.steadiness, words.share, names, words.quick)
    folder = _folder(words)
    search = search_in(folder, words.scene, words.set, options, words.jobs, words.threads, words.launcher, words.pictures,
                       _nothing if words.quiet else _tell, find_program(words.program))
    if not words.quiet:
        print(search.table())
    bracket = search.bracket
    for factor in bracket.out_of_order:
        print(f"warning: holds at {factor:.6g}, above {bracket.high:.6g}, which fails: verdicts are not in order; look at both trials",
              file=sys.stderr)
    print(f"factor of safety {search.factor:.6g}: holds at {bracket.low:.6g}, fails at {bracket.high:.6g}")
    print(f"table in {folder / 'fos.csv'}")
    return 0


def _tell(line: str) -> None:
    print(line, file=sys.stderr if line.startswith("warning: ") else sys.stdout, flush=True)


def _nothing(line: str) -> None:
    if line.startswith("warning: "):
        _tell(line)
