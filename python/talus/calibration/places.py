"""YAML with the place of each entry, and all errors of a file at once."""
from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import Message, SceneError, located
from ..packages import need

_INTEGER = re.compile(r"[-+]?\d+")
_WORDS = {"true": True, "false": False, "null": None, "~": None, "": None}


class Problems:
    """The errors of a file, each with its place, collected so that all of them are reported together."""

    def __init__(self, file: Path) -> None:
        self.file = file
        try:
            self.text = file.read_text(encoding="utf-8")
        except UnicodeDecodeError as error:
            raise SceneError(f"{file}:1:1: error: not UTF-8 ({error.reason})", 2) from error
        self.messages: list[Message] = []

    def add(self, line: int, column: int, key: str, text: str) -> None:
        """Adds an error at a line and a column, which count from 1."""
        lines = self.text.splitlines()
        source = lines[line - 1] if 0 < line <= len(lines) else ""
        message = Message("error", str(self.file), line, column, key, text, source)
        if message not in self.messages:
            self.messages.append(message)

    def raise_any(self) -> None:
        """Raises SceneError with all errors, in the order of their places; does nothing if there are none."""
        if self.messages:
            raise located(self.messages)


class Entry:
    """A node of a YAML file, with its place and its key, such as `parameters.materials[0].cohesion`."""

    def __init__(self, node: Any, key: str, problems: Problems) -> None:
        self.node, self.key, self.problems = node, key, problems

    @property
    def line(self) -> int:
        return self.node.start_mark.line + 1

    @property
    def column(self) -> int:
        return self.node.start_mark.column + 1

    @property
    def is_mapping(self) -> bool:
        return self.node.id == "mapping"

    @property
    def is_list(self) -> bool:
        return self.node.id == "sequence"

    def wrong(self, text: str) -> None:
        """Adds an error at this place."""
        self.problems.add(self.line, self.column, self.key, text)

    def items(self) -> Iterator[tuple[str, Entry]]:
        """The entries of a mapping; a key that occurs twice is an error."""
        known: set[str] = set()
        for name, value in self.node.value:
            key = str(name.value)
            if key in known:
                Entry(name, self.key, self.problems).wrong(f'key "{key}" occurs twice')
            known.add(key)
            yield key, Entry(value, f"{self.key}.{key}" if self.key else key, self.problems)

    def entries(self) -> Iterator[Entry]:
        """The entries of a list."""
        for k, node in enumerate(self.node.value):
            yield Entry(node, f"{self.key}[{k}]", self.problems)

    def number(self) -> float | None:
        """The number at this place; None, and an error, if it is none."""
        try:
            value = float(self.node.value) if self.node.id == "scalar" else float("nan")
        except ValueError:
            value = float("nan")
        if np.isfinite(value):
            return value
        self.wrong(f"{self.shown()} is no number")
        return None

    def value(self) -> Any:
        """What the entry holds: dictionaries, lists, numbers, True, False, None and text.  Numbers are those of YAML 1.2: 1e3 is one."""
        if self.is_mapping:
            return {name: entry.value() for name, entry in self.items()}
        if self.is_list:
            return [entry.value() for entry in self.entries()]
        text = self.node.value
        if self.node.style is not None:
            return text
        if text.lower() in _WORDS:
            return _WORDS[text.lower()]
        if _INTEGER.fullmatch(text):
            return int(text)
        try:
            return float(text)
        except ValueError:
            return text

    def shown(self) -> str:
        return f'"{self.node.value}"' if self.node.id == "scalar" else f"a {'list' if self.is_list else 'mapping'}"


class Block:
    """A mapping whose keys are known: each is taken by a function, and `end` reports those that nobody took."""

    def __init__(self, entry: Entry) -> None:
        self.entry, self._taken = entry, set[str]()
        self._there: dict[str, Entry] = {}
        if entry.is_mapping:
            self._there = dict(entry.items())
        else:
            entry.wrong(f"{entry.shown()} instead of a mapping")

    def take(self, name: str, *, required: bool = False) -> Entry | None:
        """The entry with a name; None, and an error if it is required, where there is none."""
        self._taken.add(name)
        if name not in self._there and required and self.entry.is_mapping:
            self.entry.wrong(f'missing key "{name}"')
        return self._there.get(name)

    def number(self, name: str, default: float | None = None, *, low: float = -np.inf, high: float = np.inf, above: float = -np.inf,
               unit: str = "") -> float | None:
        """A number in [low, high], and greater than `above`; required if it has no default."""
        entry = self.take(name, required=default is None)
        value = entry.number() if entry is not None else None
        if entry is None or value is None:
            return default
        if not (low <= value <= high and value > above):
            allowed = f"> {above:g}" if np.isfinite(above) and not np.isfinite(high) else \
                f"in ({above:g}, {high:g}]" if np.isfinite(above) else f"in [{low:g}, {high:g}]" if np.isfinite(high) else f">= {low:g}"
            entry.wrong(f"{value:g} must be {allowed}{' ' + unit if unit else ''}")
            return default
        return value

    def whole(self, name: str, default: int, *, low: int) -> int:
        """A whole number that is at least `low`."""
        entry = self.take(name)
        value = entry.number() if entry is not None else None
        if entry is None or value is None:
            return default
        if value != int(value) or value < low:
            entry.wrong(f"{value:g} must be a whole number >= {low}")
            return default
        return int(value)

    def word(self, name: str, choices: Sequence[str], default: str | None = None) -> str:
        """One of some words, the first of which is returned where there is an error; required if it has no default."""
        entry = self.take(name, required=default is None)
        if entry is None:
            return default if default is not None else choices[0]
        if entry.node.id != "scalar" or entry.node.value not in choices:
            entry.wrong(f"{entry.shown()}{meant(str(entry.node.value), choices)}")
            return choices[0]
        return entry.node.value

    def text(self, name: str, default: str | None = None) -> str:
        """Some text; required if it has no default."""
        entry = self.take(name, required=default is None)
        if entry is None:
            return default or ""
        if entry.node.id != "scalar" or not entry.node.value:
            entry.wrong(f"{entry.shown()} instead of text")
            return default or ""
        return entry.node.value

    def file(self, name: str) -> tuple[Path, Entry] | None:
        """The path of an existing file, which is named relative to the file in which it stands, and its entry."""
        entry = self.take(name, required=True)
        text = self.text(name) if entry is not None else ""
        if entry is None or not text:
            return None
        path = self.entry.problems.file.parent / text
        if not path.is_file():
            entry.wrong(f"there is no file {path}")
            return None
        return path, entry

    def end(self) -> None:
        """Reports the keys that nobody took, with the key that was probably meant."""
        for name_node, _ in self.entry.node.value if self.entry.is_mapping else []:
            name = str(name_node.value)
            if name not in self._taken:
                Entry(name_node, self.entry.key, self.entry.problems).wrong(f'unknown key "{name}"{meant(name, sorted(self._taken))}')


def meant(word: str, known: Sequence[str], otherwise: str = "") -> str:
    """What was probably meant by a wrong word; or the known words, or other text for these."""
    near = difflib.get_close_matches(word, known, 1)
    return f' — did you mean "{near[0]}"?' if near else f"; {otherwise or 'known: ' + ', '.join(known)}"


def read_yaml(file: Path) -> Entry:
    """Reads a YAML file as an entry, from which all others follow.  Raises SceneError if it is no YAML, or no mapping."""
    yaml = need("yaml", "reads YAML files")
    problems = Problems(file)
    try:
        for token in yaml.scan(problems.text, Loader=yaml.SafeLoader):
            if isinstance(token, (yaml.AnchorToken, yaml.AliasToken, yaml.TagToken)):
                problems.add(token.start_mark.line + 1, token.start_mark.column + 1, "", "anchors, aliases and tags are not read")
        problems.raise_any()
        node = yaml.compose(problems.text, Loader=yaml.SafeLoader)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        problems.add(mark.line + 1 if mark else 1, mark.column + 1 if mark else 1, "", f"no YAML: {getattr(error, 'problem', error)}")
        problems.raise_any()
    if node is None or node.id != "mapping":
        problems.add(1, 1, "", "a mapping is expected, such as `scene: scene.yaml`")
        problems.raise_any()
    return Entry(node, "", problems)
