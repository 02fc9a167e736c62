"""The commands of the package, such as python3 -m talus calibrate SPECIFICATION; the program calls them for its own."""
from __future__ import annotations

import argparse
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .calibration import calibrate, default_folder
from .calibration.evaluation import Stopped
from .convergence.command import add_converge
from .differences.command import add_diff
from .errors import EnvironmentFailure, FileError, MissingPackage, ProgramError, RunFailed, SceneError
from .program import STOPPED
from .run_queue import StoppedRuns
from .strength_reduction.command import add_fos
from .sweeps.command import add_sweep

_FAILED, _WRONG, _ENVIRONMENT = 1, 2, 3  # exit codes of the program (app/cli/main.cpp)


def main(words: Sequence[str] | None = None) -> int:
    """Runs a command and returns its exit code: 0 done, 1 runs failed, 2 wrong input, 3 the environment, 4 stopped by a signal."""
    options = _parser().parse_args(words)
    signal.signal(signal.SIGTERM, _interrupt)
    signal.signal(signal.SIGUSR1, _interrupt)
    try:
        return options.run(options)
    except StoppedRuns as stopped:
        return _complain(STOPPED, str(stopped))
    except (KeyboardInterrupt, Stopped):
        runs = f", with the runs that are done in {options.folder(options)}" if options.folder is not None else ""
        return _complain(STOPPED, f"stopped; the same command goes on{runs}")
    except SceneError as error:
        return _complain(_WRONG, str(error))
    except RunFailed as error:
        return _complain(_FAILED, str(error))
    except EnvironmentFailure as error:
        return _complain(_ENVIRONMENT, str(error))
    except ProgramError as error:  # killed by a signal, for example
        return _complain(_FAILED, str(error))
    except FileNotFoundError as error:
        if error.filename is not None and Path(error.filename) == getattr(options, "file", None):
            return _complain(_WRONG, f"there is no file {options.file}")
        return _complain(_ENVIRONMENT, str(error))
    except (OSError, MissingPackage, FileError) as error:
        return _complain(_ENVIRONMENT, str(error))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("talus", description="Commands of the Python package talus")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_calibrate(commands)
    add_sweep(commands, _count)
    add_converge(commands)
    add_fos(commands)
    add_diff(commands)
    return parser


def _add_calibrate(commands: Any) -> None:
    one = commands.add_parser("calibrate", help="find parameters of a scene from observations, with their uncertainty",
                              description="Finds parameters of a scene from observations, with their uncertainty.  Runs that are done in "
                                          "the folder are not repeated: the same command goes on.")
    one.add_argument("file", metavar="specification", type=Path, help="file (.yaml) that names scene, parameters and observations")
    one.add_argument("--out", type=Path, metavar="DIR", help="folder of runs and results; default runs/<name of the file>")
    one.add_argument("--jobs", type=_count, default=1, metavar="N", help="runs at a time; default 1")
    one.add_argument("--threads", type=_count, metavar="N", help="threads of each; default as for a run, with --jobs the cores over that")
    one.add_argument("--launcher", metavar="WORDS", help="what each run is started by, such as \"mpirun -n 4\"")
    one.add_argument("--no-pictures", dest="pictures", action="store_false", help="draw nothing")
    one.add_argument("--quiet", action="store_true", help="only the results")
    one.add_argument("--program", type=Path, metavar="PATH", help="the program talus; default as in talus.find_program")
    one.set_defaults(run=_calibrate, folder=_folder_of_calibration)


def _folder_of_calibration(options: argparse.Namespace) -> Path:
    return options.out if options.out is not None else default_folder(options.file)


def _calibrate(options: argparse.Namespace) -> int:
    out = _folder_of_calibration(options)
    print(calibrate(options.file, out=out, jobs=options.jobs, threads=options.threads, pictures=options.pictures,
                    launcher=options.launcher, program=options.program, tell=None if options.quiet else _tell))
    print(f"results in {out}: calibration.json, calibration.csv, best.yaml{', calibration.png' if options.pictures else ''}")
    return 0


def _count(word: str) -> int:
    if not word.isdecimal() or not 1 <= int(word) <= 1024:
        raise argparse.ArgumentTypeError(f"{word} is no number from 1 to 1024")
    return int(word)


def _interrupt(*_: Any) -> None:
    raise KeyboardInterrupt


def _tell(line: str) -> None:
    print(line, flush=True)


def _complain(code: int, text: str) -> int:
    print(text if ": error: " in text or text.startswith("error: ") else f"error: {text}", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
