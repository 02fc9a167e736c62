"""Scenes as dictionaries: written as YAML for the program, which is the one that checks them."""
from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

Scene = Union[str, "os.PathLike[str]", Mapping[str, Any]]  #: the path of a scene file, or a scene as a dictionary

HEADING = "# Written by the Python package talus; the next run into the same folder replaces it.\n"
_PLAIN = re.compile(r"[A-Za-z_][\w.-]*")
_NOT_PLAIN = {"true", "false", "yes", "no", "on", "off", "y", "n", "null"}  # words that YAML 1.1 or 1.2 reads as something else


def _is_list(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.ndim > 0
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes))


def _scalar(value: Any) -> str:
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, os.PathLike):
        return json.dumps(str(Path(value).absolute()), ensure_ascii=False)
    if isinstance(value, str):
        plain = _PLAIN.fullmatch(value) and value.lower() not in _NOT_PLAIN
        return value if plain else json.dumps(value, ensure_ascii=False)
    raise TypeError(f"a scene has no place for {value!r} ({type(value).__name__}): "
                    "it has dictionaries, lists, text, numbers, True, False and paths")


def _key(name: Any) -> str:
    if not isinstance(name, str):
        raise TypeError(f"the keys of a scene are text, not {name!r} ({type(name).__name__})")
    return name if _PLAIN.fullmatch(name) else json.dumps(name, ensure_ascii=False)


def _entries(mapping: Mapping[str, Any]) -> list[tuple[str, Any]]:
    return [(name, value) for name, value in mapping.items() if value is not None]


def flow(value: Any) -> str:
    """A value as YAML on one line, as the option --set takes it."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(name)}: {flow(entry)}" for name, entry in _entries(value)) + "}"
    if _is_list(value):
        return "[" + ", ".join(map(flow, value)) + "]"
    return _scalar(value)


def _block(value: Any, indent: str) -> Iterator[str]:
    """Lines of a mapping, or of a list of mappings."""
    if isinstance(value, Mapping):
        for name, entry in _entries(value):
            if _is_nested(entry):
                yield f"{indent}{_key(name)}:"
                yield from _block(entry, indent + "  ")
            else:
                yield f"{indent}{_key(name)}: {flow(entry)}"
        return
    for entry in value:
        lines = list(_block(entry, indent + "  ")) if isinstance(entry, Mapping) and _entries(entry) else [f"{indent}  {flow(entry)}"]
        yield f"{indent}- {lines[0].lstrip()}"
        yield from lines[1:]


def _is_nested(value: Any) -> bool:
    """Whether a value gets lines of its own: mappings of more than numbers and words, and lists of mappings."""
    if isinstance(value, Mapping):
        return any(isinstance(entry, Mapping) or _is_list(entry) and _is_nested(entry) for _, entry in _entries(value)) or len(value) > 4
    return _is_list(value) and any(isinstance(entry, Mapping) for entry in value)


def to_yaml(scene: Mapping[str, Any]) -> str:
    """A scene as YAML, one line for each entry.

    Values are dictionaries, lists, text, numbers, True and False, also those of numpy.  An entry that is None is left out.
    Name files by a `pathlib.Path`, which is written as an absolute path.  Text stays as it is: a file name in it is relative to the file of
    the scene, wherever that is written.
    The scene is not checked: `talus.check` does that.  Raises TypeError for anything else.
    """
    return "".join(f"{line}\n" for line in _block(scene, ""))


def set_options(changes: Mapping[str, Any] | None) -> list[str]:
    """The options --set of the program: {"time.end": 2, "bodies[0].velocity": [1, 0]}."""
    words: list[str] = []
    for key, value in (changes or {}).items():
        words += ["--set", f"{key}={flow(value)}"]
    return words


def write_scene(scene: Mapping[str, Any], path: Path) -> Path:
    """Writes a scene, and replaces only a file that this function wrote.  Raises FileExistsError if another file has this name."""
    text = HEADING + to_yaml(scene)
    if path.exists() and not path.read_text(encoding="utf-8", errors="replace").startswith(HEADING):
        raise FileExistsError(f"{path} was not written by this package and is not replaced: "
                              "move it, or choose another folder for the results")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path
