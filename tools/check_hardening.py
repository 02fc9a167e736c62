#!/usr/bin/python3
"""Fails where programs and shared libraries were not built as Debian builds them (dpkg-buildflags, hardening=+all).

Usage: check_hardening.py FILE...      one line for each fault; exit status 1 if there was any

Of each file: position independent, segments read-only once relocated (RELRO), all symbols bound at the start (BIND_NOW), no executable stack.
Of all files together, since a small one may have no function that asks for it: stack protector and _FORTIFY_SOURCE.
"""
import re
import subprocess
import sys


def told(option, path):
    return subprocess.run(["readelf", "-W", option, path], capture_output=True, text=True, check=True).stdout


def faults_of(path):
    header, segments, dynamic = told("-h", path), told("-l", path), told("-d", path)
    found = []
    if not re.search(r"Type:\s+DYN", header):
        found.append("is not position independent (-fPIE -pie)")
    if "GNU_RELRO" not in segments:
        found.append("has no segment that is made read-only (-Wl,-z,relro)")
    if not re.search(r"\(BIND_NOW\)|\(FLAGS\).*BIND_NOW|\(FLAGS_1\).*NOW", dynamic):
        found.append("binds symbols while it runs (-Wl,-z,now)")
    stack = re.search(r"GNU_STACK.*?\s(\S+)\s+0x[0-9a-f]+$", segments, re.MULTILINE)
    if not stack or "E" in stack.group(1):
        found.append("has a stack that can be executed")
    return [f"{path}: {fault}" for fault in found]


def check(paths):
    """All faults, one a line."""
    found = [fault for path in paths for fault in faults_of(path)]
    symbols = "".join(told("--dyn-syms", path) for path in paths)
    if not re.search(r"\b__stack_chk_fail\b", symbols):
        found.append("no function has a stack protector (-fstack-protector-strong)")
    if not re.search(r"\b__(?!stack)\w+_chk\b", symbols):
        found.append("no function is checked for what it writes (-D_FORTIFY_SOURCE=2)")
    return found


def main(paths):
    if not paths:
        print(__doc__, file=sys.stderr)
        return 2
    found = check(paths)
    print("\n".join(found) if found else f"hardening: {len(paths)} files, nothing is missing")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
