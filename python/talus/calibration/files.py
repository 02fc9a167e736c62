"""Files that are written completely or not at all, and folders with one writer."""
from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..errors import EnvironmentFailure


@contextlib.contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """The path of a new file beside `path`, which takes its name when the block ends without an exception and is removed otherwise."""
    new = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        yield new
        with new.open("rb") as file:
            os.fsync(file.fileno())
        new.replace(path)
    finally:
        new.unlink(missing_ok=True)


def write_whole(path: Path, text: str) -> None:
    """Writes a text file, which is there completely or, if this fails, as it was."""
    with replaced(path) as new:
        new.write_text(text, encoding="utf-8")


def save_figure(figure: Any, path: Path) -> None:
    """Writes a figure of Matplotlib as .png, completely or not at all."""
    with replaced(path) as new:
        figure.savefig(new, format="png", dpi=120)


@contextlib.contextmanager
def only_writer(folder: Path) -> Iterator[None]:
    """Keeps other processes from the folder during the block, where the file system supports locks.  Raises EnvironmentFailure if another
    one is at work there."""
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise EnvironmentFailure(f"another process is at work in {folder}", 3) from error
        except OSError:
            pass  # no locks here
        yield
    finally:
        os.close(handle)
