"""The program `talus`: where it is, how it is called, and what it says."""
from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .errors import EnvironmentFailure, Message, ProgramError, RunFailed, SceneError

_REPOSITORY = Path(__file__).resolve().parents[2]
_ERRORS: dict[int, type[ProgramError]] = {1: RunFailed, 2: SceneError, 3: EnvironmentFailure}
STOPPED = 4  # exit code of a run that was stopped on request (app/cli/main.cpp)

_LOCATED = re.compile(r"(?:(?P<file>.+?)(?::(?P<line>\d+)(?::(?P<column>\d+))?)?: )?(?P<kind>error|warning): (?P<rest>.*)")
_NAME = r'[a-z]\w*(?:\[\d+\](?: "[^"]*")?)?'
_KEY = re.compile(rf"(?P<key>{_NAME}(?:\.{_NAME})*): (?P<text>.*)")
_PLACE = re.compile(r"\((?P<file>[^()\s:]+\.\w+):(?P<line>\d+):(?P<column>\d+)\)")  # of a body, in the error of a run
_SOURCE = re.compile(r" *\d+ \| (.*)")


def find_program(program: str | os.PathLike[str] | None = None) -> Path:
    """The path of the program `talus`.

    program  the program itself; default: the environment variable TALUS, then `talus` on PATH, then build/talus of the repository to which
             this package belongs

    Raises FileNotFoundError if it is in none of these places, or if the one that is named is no program.
    """
    for source, named in (("program", program), ("the environment variable TALUS", os.environ.get("TALUS"))):
        if named:
            found = shutil.which(Path(named).expanduser())
            if found is None:
                raise FileNotFoundError(f"{source} names {os.fspath(named)}, which is no program")
            return Path(found).absolute()
    on_path = shutil.which("talus")
    built = _REPOSITORY / "build" / "talus"
    if on_path is None and not os.access(built, os.X_OK):
        raise FileNotFoundError("the program talus was not found: set the environment variable TALUS to its path, add its folder to PATH, "
                                "or build it (make build in a clone)")
    return Path(on_path).absolute() if on_path is not None else built


def messages_of(text: str) -> list[Message]:
    """The errors and warnings in what the program printed, in their order; other lines are left out."""
    found: list[Message] = []
    lines = text.splitlines()
    for line, after in zip(lines, [*lines[1:], ""]):
        located = _LOCATED.fullmatch(line)
        if not located:
            continue
        rest, key, source = located["rest"], "", _SOURCE.fullmatch(after)
        if located["file"] and (keyed := _KEY.fullmatch(rest)):
            key, rest = keyed["key"], keyed["text"]
        place = located if located["file"] else _PLACE.search(rest) or located
        found.append(Message(located["kind"], place["file"] or "", int(place["line"] or 0), int(place["column"] or 0), key, rest,
                             source[1] if source and located["line"] else ""))
    return found


def error_of(code: int, complaints: str, log: str, **more: Any) -> ProgramError:
    """The exception for an exit code other than 0, with what the program printed."""
    text = complaints.strip() or (f"talus was killed by signal {-code}" if code < 0 else f"talus ended with exit code {code}")
    return _ERRORS.get(code, ProgramError)(text, code, messages_of(complaints), log, **more)


def call(words: Sequence[str | os.PathLike[str]], program: str | os.PathLike[str] | None = None) -> str:
    """Runs a command of the program to its end and returns what it prints.  Raises a ProgramError if it fails."""
    told = subprocess.run([find_program(program), *words], stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8",
                          errors="replace", check=False)
    if told.returncode:
        raise error_of(told.returncode, told.stderr, told.stdout)
    return told.stdout


def manual(*keys: str, program: str | os.PathLike[str] | None = None) -> str:
    """What the keys of a scene mean, as Markdown, with unit, range and default: `print(talus.manual("friction_angle", "mesh.grid"))`.
    Without keys: all of them.  Raises SceneError if there is no such key."""
    return call(["manual", *keys], program)


def facts_of(scene: Path, changes: Sequence[str] = (), *, keys_only: bool = False,
             program: str | os.PathLike[str] | None = None) -> dict[str, Any]:
    """What a scene with changes such as "time.end=2" consists of: stages, bodies with their laws and particles, the mesh, all keys.

    keys_only  checks the keys alone: no mesh is made, and particles are left out

    Raises SceneError with the place of each error.
    """
    words = [word for change in changes for word in ("--set", change)]
    return json.loads(call(["check", str(scene), *words, "--json", *(["--keys"] if keys_only else [])], program))


@dataclass(frozen=True)
class Variant:
    """What the program finds in a scene with changes (io/output/variants_json.hpp).  What a check does not reach is empty, or 0.

    fronts     columns of run-out in its history
    cells      of its mesh
    cell_size  (volume of the mesh / cells)^(1 / dimension) [m]
    """

    scene_digest: str
    mesh_digest: str
    fronts: list[str]
    cells: int
    cell_size: float
    particles: int
    errors: list[Message]


def check_variants(scene: Path, variants: Sequence[tuple[Sequence[str], str]], depth: str, *, quick: bool,
                   program: Path) -> tuple[str, list[Variant]]:
    """Checks a scene with several sets of changes; returns the commit of the program, and what it found in each.

    variants  changes such as "time.end=2", and the digest of a mesh with which the model is known to be in order, or an empty text
    depth     "scenes", "meshes", or "models"
    """
    asked = {"check": depth, "quick": quick, "variants": [{"set": list(changes), "built_on": mesh} for changes, mesh in variants]}
    with tempfile.NamedTemporaryFile("w", suffix=".json", prefix="talus_variants_", encoding="utf-8") as file:
        json.dump(asked, file)
        file.flush()
        answer = json.loads(call(["check", str(scene), "--variants", file.name], program))
    return answer["commit"], [Variant(one["scene_digest"], one["mesh_digest"], one["fronts"], one["cells"], one["cell_size [m]"],
                                      one["particles"], [Message("error", **error) for error in one["errors"]])
                              for one in answer["variants"]]


def schema(program: str | os.PathLike[str] | None = None) -> dict[str, Any]:
    """The JSON Schema of scenes, for editors and other programs.  `talus.check` is the full check of a scene."""
    return json.loads(call(["manual", "--schema"], program))
