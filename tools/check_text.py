#!/usr/bin/python3
"""Fails on text that means something on one machine or in one tracker only: absolute paths of a home, paths out of the tree, issue numbers.

Usage: check_text.py [root]      prints file:line: what is wrong, one a line; exit status 1 if there was any.
"""
import pathlib
import re
import subprocess
import sys

BLANKS = "blanks at the end of a line"
FORBIDDEN = [
    (re.compile(r"(?<![\w.}])/(work|home|root|Users)/\w"), "an absolute path of one machine"),
    (re.compile(r"\.\./(\.\./)*shared\b"), "a path out of the repository"),
    (re.compile(r"\bissue\s*#\s*\d|\bfixes\s+#\d", re.IGNORECASE), "the number of an issue: say what it was about"),
    (re.compile(r"^(<<<<<<<|>>>>>>>)( |$)"), "a conflict left over"),
    (re.compile(r"[ \t]+$"), BLANKS),
]
WRITTEN_BY_PROGRAMS = {".msh", ".csv", ".svg"}   # their blanks are not ours
BINARY = {".png", ".jpg", ".gif", ".ico", ".pdf", ".vtp", ".vtu"}
NOT_OURS = {"LICENSE"}
DAMAGED_ON_PURPOSE = ("tests/io/bad_", "tests/fuzz/corpus/")
SHOWN = 5   # findings of one file


def check_text(path, text):
    """All findings in one file, as 'path:line: reason'."""
    generated = pathlib.PurePath(path).suffix in WRITTEN_BY_PROGRAMS
    found = [f"{path}:{number}: {reason}" for number, line in enumerate(text.split("\n"), start=1)
             for pattern, reason in FORBIDDEN if pattern.search(line) and not (generated and reason == BLANKS)]
    return found if len(found) <= SHOWN else [*found[:SHOWN], f"{path}: and {len(found) - SHOWN} more"]


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    names = subprocess.run(["git", "-C", root, "ls-files", "-z"], check=True, capture_output=True, text=True).stdout.split("\0")
    files = [n for n in names if n and pathlib.Path(n).suffix not in BINARY and n not in NOT_OURS
             and not n.startswith(DAMAGED_ON_PURPOSE) and (root / n).is_file()]
    found = []
    for name in files:
        try:
            found += check_text(name, (root / name).read_text(encoding="utf-8"))
        except UnicodeDecodeError as error:
            found.append(f"{name}:1: not UTF-8 ({error.reason})")
    print("\n".join(found) if found else f"text: {len(files)} files, nothing forbidden")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
