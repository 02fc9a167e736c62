#!/usr/bin/env python3
"""Runs the tutorials as their pages tell: a page promises nothing that does not happen.

Usage: run_tutorials.py TALUS [--only NAME ...] [--pictures]

Of each page of docs/tutorials, in the order of its blocks:
  a block after a line that ends with `NAME`:          is written to the file NAME of a scratch folder
  a block after a line that ends with [`NAME`](PATH):  must stand word for word in the file at PATH
  a block of sh                                        is run there by bash, with `talus` on PATH; `# writes A B` in it: these files must be there then
  a block of text after it                             must be what its commands print: line by line and in order, `...` for anything between or
                                                       at the end of a line, numbers within 5 %
--pictures copies what the commands draw to the places from which the page shows it.  Exit 1 where a promise is broken; times are printed.
"""
import argparse
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGES = ROOT / "docs/tutorials"
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.S | re.M)
NAMED = re.compile(r"`([\w./-]+)`:$")
QUOTED = re.compile(r"\[`[\w./-]+`\]\(([\w./-]+)\):$")
NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?", re.I)
NEAR = 0.05    # numbers differ a little from processor to processor once soil slides along a band


class Broken(Exception):
    """An error: a page does not agree with the program."""


def same_word(said, shown):
    """Whether two words are equal, with a tolerance for numbers."""
    if said == shown:
        return True
    if NUMBER.sub("#", said) != NUMBER.sub("#", shown):
        return False
    pairs = zip(NUMBER.findall(said), NUMBER.findall(shown))
    return all(math.isclose(float(a), float(b), rel_tol=NEAR, abs_tol=1e-12) for a, b in pairs)


def same_line(said, shown):
    said, shown = said.split(), shown.split()
    if said and said[-1] == "...":
        said, shown = said[:-1], shown[:len(said) - 1]
    return len(said) == len(shown) and all(map(same_word, said, shown))


def check_printed(promised, printed):
    """Raises Broken unless all shown lines were printed, in order."""
    rest, skip = iter(printed.splitlines()), True
    for line in filter(str.strip, promised.splitlines()):
        if line.strip() == "...":
            skip = True
            continue
        for shown in rest:
            if same_line(line, shown):
                break
            if shown.strip() and not skip:
                raise Broken(f"promised:\n  {line}\nprinted:\n  {shown}")
        else:
            raise Broken(f"promised and not printed:\n  {line}\nprinted was:\n{printed[-3000:]}")
        skip = False


def blocks(text):
    """(words before, language, text) of each fenced block."""
    return [(text[:m.start()].rstrip().rsplit("\n", 1)[-1], m[1], m[2]) for m in BLOCK.finditer(text)]


def run(page, talus, scratch):
    """Runs the commands of a page in an empty folder."""
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    environment = {**os.environ, "PATH": f"{talus.parent}:{os.environ['PATH']}", "OMP_WAIT_POLICY": "passive"}
    printed = None
    for before, language, text in blocks(page.read_text(encoding="utf-8")):
        if quoted := QUOTED.search(before):
            if text not in (page.parent / quoted[1]).read_text(encoding="utf-8"):
                raise Broken(f"what is shown of {quoted[1]} does not stand there:\n{text[:400]}")
        elif named := NAMED.search(before):
            (scratch / named[1]).write_text(text, encoding="utf-8")
        elif language == "sh":
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=scratch, env=environment, capture_output=True, text=True)
            printed = done.stdout + done.stderr
            if done.returncode:
                raise Broken(f"exit code {done.returncode} of\n{text}\n{printed[-3000:]}")
            for name in (n for names in re.findall(r"# writes (.+)", text) for n in names.split()):
                if not (scratch / name).is_file() or (scratch / name).stat().st_size == 0:
                    raise Broken(f"not written: {name}, by\n{text}")
        elif language == "text" and printed is not None:
            check_printed(text, printed)


def take_pictures(page, scratch):
    """Copies drawn pictures to the files that the page shows."""
    for target in re.findall(r"!\[[^]]*\]\(([^)]+)\)", page.read_text(encoding="utf-8")):
        drawn = scratch / Path(target).name
        if drawn.is_file():
            (page.parent / target).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(drawn, page.parent / target)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("talus", type=Path)
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--pictures", action="store_true")
    options = parser.parse_args()
    talus = options.talus.absolute()
    if not talus.is_file():
        sys.exit(f"no program at {talus}: make build")
    failed, all_seconds = [], 0.0

    def processor():
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    for page in sorted(p for p in PAGES.glob("*.md") if p.stem != "quickstart"):  # whose commands install and build Talus
        if options.only and page.stem not in options.only:
            continue
        scratch, start, start_processor = ROOT / "build/tutorials" / page.stem, time.monotonic(), processor()
        try:
            run(page, talus, scratch)
            if options.pictures:
                take_pictures(page, scratch)
            verdict = "as told"
        except Broken as broken:
            failed.append(page.stem)
            verdict = f"NOT as told\n{broken}"
        seconds = time.monotonic() - start
        all_seconds += seconds
        print(f"tutorial {page.stem}: {seconds:.1f} s, {processor() - start_processor:.1f} s of processor, {verdict}", flush=True)
    print(f"tutorials: {all_seconds:.1f} s, {processor():.1f} s of processor" + (f", broken: {', '.join(failed)}" if failed else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
