#!/usr/bin/env python3
"""Documentation against the tree: relative links lead somewhere, and every complete scene shown passes `talus check`
(those of the tutorials are run by run_tutorials.py).

Usage: check_docs.py [TALUS]     without a program only the links are checked.  Exit 1 on a finding.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)]*)?\)")
RUN_AS_TOLD = Path("docs/tutorials")    # with the files that their scenes need: tools/run_tutorials.py
SCENE = re.compile(r"^```yaml\n(title:.*?)^```", re.S | re.M)


def pages() -> list[Path]:
    listed = subprocess.run(["git", "ls-files", "*.md"], check=True, capture_output=True, text=True).stdout
    return [Path(name) for name in listed.split()]


def broken_links(page: Path) -> list[str]:
    targets = (match.group(1) for match in LINK.finditer(page.read_text()))
    return [f"{page}: link to {t}, which is not there" for t in targets if "://" not in t and not (page.parent / t).exists()]


def wrong_scenes(page: Path, talus: str) -> list[str]:
    findings = []
    for match in SCENE.finditer(page.read_text()):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as scene:
            scene.write(match.group(1))
            scene.flush()
            result = subprocess.run([talus, "check", scene.name], capture_output=True, text=True)
        if result.returncode:
            findings.append(f"{page}: the scene shown fails:\n{result.stdout}{result.stderr}")
    return findings


def main() -> int:
    findings = [finding for page in pages() for finding in broken_links(page)]
    if len(sys.argv) > 1:
        findings += [finding for page in pages() if page.parent != RUN_AS_TOLD for finding in wrong_scenes(page, sys.argv[1])]
    print("\n".join(findings), end="\n" if findings else "")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
