#!/usr/bin/python3
"""Writes what a build of Talus is made of, as a CycloneDX 1.5 file: which Debian packages its programs load, and in which version, which
libraries of headers are compiled into them, and which npm packages are in the page of talus report or made it.

Usage: write_sbom.py VERSION OUT.json FILE...      FILE: the programs and libraries of the build

The same build on the same system gives the same file: it holds no time and no random number.
"""
import base64
import hashlib
import json
import os
import re
import subprocess
import sys
import uuid
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
HEADERS_ONLY = ("libeigen3-dev", "libcli11-dev", "nlohmann-json3-dev")  # no library to load tells of them
ROOT = "talus"


def run(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": "C"}).stdout


def needed(path):
    """Names of the libraries that a program names itself."""
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", run("readelf", "-d", path)))


def loaded(path):
    """Where the loader finds all libraries of a program: {name: path}."""
    found = re.findall(r"^\s*(\S+) => (/\S+) \(", run("ldd", path), re.MULTILINE)
    return dict(found)


def owners(paths):
    """The Debian package of each file that one has: {path: package}. Since /lib may be a link to /usr/lib, both names are asked for."""
    asked = {}
    for path in paths:
        real = os.path.realpath(path)
        for name in {path, real, *(n.removeprefix("/usr") for n in (path, real))}:
            asked[name] = path
    found = {}
    for line in run("dpkg-query", "-S", *sorted(asked)).splitlines():
        packages, _, name = line.partition(": ")
        if name in asked:
            found[asked[name]] = packages.split(",")[0].split(":")[0]
    return found


def release():
    """Which distribution this is, as a package URL calls it."""
    told = dict(line.split("=", 1) for line in Path("/etc/os-release").read_text(encoding="utf-8").splitlines() if "=" in line)
    name = told.get("ID", "debian").strip('"')
    return name, f"{name}-{told.get('VERSION_ID', '').strip(chr(34))}".rstrip("-")


def debian_components(packages):
    """A component for each package: {package: component}."""
    name, distribution = release()
    made = {}
    listed = run("dpkg-query", "-W", "-f=${Package}\t${Version}\t${Architecture}\t${source:Package}\t${Maintainer}\n", *sorted(packages))
    for line in listed.splitlines():
        package, version, architecture, source, maintainer = line.split("\t")
        made[package] = {
            "type": "library", "bom-ref": f"pkg:deb/{name}/{package}@{version}", "name": package, "version": version, "supplier": {"name": maintainer},
            "purl": f"pkg:deb/{name}/{package}@{version.replace('+', '%2B').replace(':', '%3A')}?arch={architecture}&distro={distribution}",
            "properties": [{"name": "debian:source", "value": source}],
        }
    return made


def page_components(lock):
    """What page/package-lock.json names: what is in the page is required, what only made or tests it is excluded."""
    made = []
    for path, entry in sorted(lock["packages"].items()):
        if not path or entry.get("optional"):  # the page itself; builds of esbuild for other machines
            continue
        name = path.rpartition("node_modules/")[2]
        algorithm, _, digest = entry["integrity"].partition("-")
        made.append({
            "type": "library", "bom-ref": f"pkg:npm/{name}@{entry['version']}", "name": name, "version": entry["version"],
            "scope": "excluded" if entry.get("dev") else "required",
            "hashes": [{"alg": algorithm.upper().replace("SHA", "SHA-"), "content": base64.b64decode(digest).hex()}],
            "licenses": [{"license": {"id": entry["license"]}}],
            "purl": f"pkg:npm/{name.replace('@', '%40')}@{entry['version']}",
        })
    return made


def sbom(version, files, lock):
    """The whole document."""
    own = {Path(file).name for file in files}
    direct, places = set(), {}
    for file in files:
        direct |= needed(file) - own
        places |= {name: path for name, path in loaded(file).items() if name not in own}
    package_of = owners(places.values())
    strangers = sorted(name for name, path in places.items() if path not in package_of)
    if strangers:
        raise SystemExit(f"error: no Debian package has {', '.join(strangers)}")
    named = {package_of[places[name]] for name in direct if name in places}
    compiled_in = set(HEADERS_ONLY)
    deb = debian_components(set(package_of.values()) | compiled_in)
    for package, component in deb.items():
        role = "compiled into it" if package in compiled_in else "named by it" if package in named else "brought by another library"
        component["scope"] = "required"
        component["properties"].append({"name": "talus:role", "value": role})
    npm = page_components(lock)
    components = [deb[package] for package in sorted(deb)] + npm
    used = [deb[package]["bom-ref"] for package in sorted(deb) if package in named | compiled_in]
    used += [component["bom-ref"] for component in npm if component["scope"] == "required"]
    document = {
        "bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
        "metadata": {"component": {"type": "application", "bom-ref": ROOT, "name": "talus", "version": version,
                                   "licenses": [{"license": {"id": "Apache-2.0"}}]}},
        "components": components,
        "dependencies": [{"ref": ROOT, "dependsOn": used}],
    }
    digest = hashlib.sha256(json.dumps(document, sort_keys=True).encode()).hexdigest()
    return {**document, "serialNumber": f"urn:uuid:{uuid.UUID(digest[:32], version=4)}"}


def main(words):
    if len(words) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    version, out, *files = words
    lock = json.loads((SOURCE / "page/package-lock.json").read_text(encoding="utf-8"))
    document = sbom(version, files, lock)
    Path(out).write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
