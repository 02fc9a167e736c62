"""Errors of files, and of names that are not in them."""
from __future__ import annotations

import difflib
from collections.abc import Sequence


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
