"""Errors of files, of names that are not in them, of missing packages, and of the program."""
from __future__ import annotations

import difflib
from collections.abc import Sequence
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
    """The error of wrong input with these messages, as the program writes them."""
    lines = []
    for message in messages:
        place = ":".join([message.file, *(str(n) for n in (message.line, message.column) if n)] if message.file else [])
        lines.append(": ".join(part for part in (place, message.kind, message.key, message.text) if part))
    return SceneError("\n".join(lines), 2, messages)
