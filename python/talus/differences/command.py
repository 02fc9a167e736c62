"""The command: python3 -m talus diff A B."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ..errors import FileError, Missing, SceneError
from . import diff

_DIFFER = 1  # exit code


def add_diff(commands: Any) -> None:
    """Adds the command to a parser."""
    one = commands.add_parser("diff", help="compare the results of two runs, field by field",
                              description="Compares the results of two runs.  Exit code 0: the same, 1: different, 2: not to be compared.")
    one.add_argument("a", type=Path, help="results of a run")
    one.add_argument("b", type=Path, help="results of another run")
    for name, text in (("relative", "allowed difference over the largest value of the field in both runs; default 0"),
                       ("absolute", "allowed difference, in the unit of each field, besides that; default 0")):
        one.add_argument(f"--{name}", type=float, default=0.0, metavar="X", help=text)
    one.add_argument("--field", action="append", default=[], metavar="A,B", help="compare only these fields")
    one.add_argument("--last", action="store_true", help="compare only the last time that both runs have")
    one.add_argument("--program", type=Path, help=argparse.SUPPRESS)  # of the launcher, for all commands
    one.set_defaults(run=_run, out=None)


def _run(words: argparse.Namespace) -> int:
    names = [name for entry in words.field for name in entry.split(",")]
    try:
        found = diff(words.a, words.b, relative=words.relative, absolute=words.absolute, fields=names, last=words.last)
    except (FileError, Missing, OSError, ValueError) as error:  # so that 1 always means different results
        raise SceneError(str(error), 2) from error
    print(found)
    return 0 if found.same else _DIFFER
