"""Errors of files, of names that are not in them, of missing packages, and of the program."""
from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from .runs import Run


class FileError(Exception):
    """A file that cannot be read; the text begins with its path."""


class Damaged(FileError):
    """A file that is truncated or inconsistent."""


class UnknownFormat(FileError):
    """A file of another program, or of a version of Talus that this module cannot read."""


class Missing(KeyError):
    """A field, column, array or body that does not exist; the text lists the existing ones."""

    def __init__(self, where: object, what: str, name: object, there: Sequence[str]) -> None:
        like = difflib.get_close_matches(str(name), there, 1)
        hint = f"did you mean {like[0]}?" if like else "there are " + ", ".join(there) if there else "there are none"
        super().__init__(f"{where}: no {what} {name}: {hint}")

    def __str__(self) -> str:
        return self.args[0]


class MissingPackage(ImportError):
    """A Python package that is not installed; the text names the package of Debian or of pip."""


class Message(NamedTuple):
    """An error or a warning of the program, with its place in the input.  Lines and columns count from 1; 0 means unknown."""

    kind: str    #: "error" or "warning"
    file: str    #: file, or the option `--set key=value`; empty if unknown
    line: int
    column: int
    key: str     #: key of the scene, such as `materials[0] "clay".density`; empty if unknown
    text: str    #: what was found, and what would be right
    source: str  #: text of the line; empty if unknown

    @property
    def place(self) -> str:
        """File, line and column, as far as they are known: "slope.yaml:3:7"."""
        return ":".join([self.file, *(str(n) for n in (self.line, self.column) if n)] if self.file else [])


class ProgramError(RuntimeError):
    """The program ended with an error; the text is what it said.

    code      exit code of the program; negative: the number of the signal that killed it
    messages  the errors and warnings, each with its place
    log       what the program had printed before
    run       results so far, for a run that began; otherwise None
    """

    def __init__(self, text: str, code: int, messages: Sequence[Message] = (), log: str = "", run: Run | None = None) -> None:
        super().__init__(text)
        self.code, self.messages, self.log, self.run = code, list(messages), log, run

    @property
    def errors(self) -> list[Message]:
        """The messages that are errors."""
        return [message for message in self.messages if message.kind == "error"]


class SceneError(ProgramError, ValueError):
    """Wrong input: a scene, a mesh or an option (exit code 2).  Nothing was run."""


class RunFailed(ProgramError):
    """A run or a test that failed (exit code 1); `run` has the results so far."""


class EnvironmentFailure(ProgramError):
    """A failure of disk, memory or display, or a folder that must not be replaced (exit code 3)."""


def located(messages: Sequence[Message]) -> SceneError:
    """The error of wrong input with these messages in the order of their places, as the program writes them."""
    messages = sorted(messages, key=lambda message: (message.file, message.line, message.column))
    count = len(messages)
    return SceneError("\n".join([*map(_as_told, messages), f"{count} error{'s' if count > 1 else ''}, nothing was run."]), 2, messages)


def _as_told(message: Message) -> str:
    """An error with its place and key, the line, and a mark below the column."""
    shown = f"\n{message.line:5} | {message.source}\n      | {' ' * (message.column - 1)}^" if message.source else ""
    return ": ".join(part for part in (message.place, message.kind, message.key, message.text) if part) + shown


def check_ranges(values: Mapping[str, tuple[float | None, float, float]], problems: Iterable[str] = ()) -> None:
    """Raises SceneError with these problems of options and with each value that is outside its range {name: (value, low, high)}; None
    stands for a default."""
    wrong = [*problems, *(f"{name} {value:g} must be in [{low:g}, {high:g}]" for name, (value, low, high) in values.items()
                          if value is not None and not low <= value <= high)]
    if wrong:
        raise SceneError("\n".join(f"error: {text}" for text in wrong), 2)
