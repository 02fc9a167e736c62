#!/usr/bin/python3
"""Fails on any include that the layers forbid: folders see only what is below them, a third-party header only its own file.

Usage: check_layers.py [root]      prints file:line: what is wrong, one a line; exit status 1 if there was any.
"""
import fnmatch
import pathlib
import re
import sys

BELOW = {  # folder -> folders it may include, besides itself
    "core": [],
    "mesh": ["core"],
    "kernels": ["core", "mesh"],
    "materials": ["core"],
    "solver": ["core", "mesh", "kernels", "materials"],
    "io": ["core", "mesh", "kernels", "materials"],
    "app": ["core", "mesh", "kernels", "materials", "solver", "io"],
}
BELOW_TESTS = {**{folder: [folder, *below] for folder, below in BELOW.items()},
               "fuzz": [*BELOW], "tutorials": ["core", "mesh", "kernels", "materials", "solver"], "ranks": [*BELOW], "speed": ["core", "mesh", "kernels", "materials", "solver"]}

# header pattern, files that may include it; tests/io/report_test.cpp may include what io/report.cpp may. The first match decides.
THIRD_PARTY = [
    ("Eigen/*", ["*"]),
    ("fmt/*", ["*"]),
    ("omp.h", ["core/parallel.hpp", "core/parallel.cpp"]),
    ("mpi.h", ["core/exchange.cpp"]),
    ("immintrin.h", ["core/lanes.hpp"]),
    ("metis.h", ["mesh/partition.cpp"]),
    ("yaml-cpp/*", ["io/reader.cpp"]),
    ("gmsh.h*", ["io/gmsh_*.cpp"]),
    ("gdal*", ["io/gdal_*"]),
    ("ogr_*", ["io/gdal_*"]),
    ("cpl_*", ["io/gdal_*"]),
    ("vtk*", ["io/vtk*.cpp", "io/render*"]),
    ("nlohmann/*", ["io/*json*.cpp", "io/report.cpp", "io/manual.cpp", "tests/io/page_test.cpp"]),
    ("hdf5.h", ["io/hdf5*", "io/array_*.cpp"]),
    ("zlib.h", ["io/page_block.cpp", "tests/io/page_test.cpp"]),
    ("CLI/*", ["app/cli.cpp", "app/cli_checks.hpp"]),
    ("muParser*", ["app/expression.cpp"]),
    ("gtest/*", ["tests/*"]),
    ("gmock/*", ["tests/*"]),
    ("benchmark/*", ["tests/speed/*"]),
    ("talus_version.hpp", ["core/version.cpp"]),
]
SYSTEM = re.compile(r"[a-z0-9_]+|((sys|netinet)/)?(unistd|fcntl|file|uio|wait|stat|types|resource|time|mman|ioctl|utsname|sysinfo|signal|termios|dlfcn|cxxabi|execinfo|sched|socket|poll|in)\.h")
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')
OMP = re.compile(r'(#\s*pragma\s+omp\b|_Pragma\s*\(\s*"omp\b)(?P<rest>.*)')


def fits(path, patterns):
    as_source = path.removeprefix("tests/").replace("_test.cpp", ".cpp")
    return any(fnmatch.fnmatch(path, pattern) or fnmatch.fnmatch(as_source, pattern) for pattern in patterns)


def wrong_include(path, quote, header):
    """Why this file may not include this header, or None."""
    parts, target = path.split("/"), header.split("/")
    if ".." in target:
        return f'"{header}" climbs out of its folder: write the path from the root of the repository'
    if len(target) > 1 and target[0] in BELOW and quote == '"':
        folder = parts[0]
        allowed = BELOW_TESTS.get(parts[1], []) if folder == "tests" else [folder, *BELOW.get(folder, [])]
        return None if target[0] in allowed else f'{"/".join(parts[:-1])} may not include {target[0]} ("{header}")'
    if quote == '"' and target[0] == "tests":
        return None if parts[0] == "tests" else f'only tests may include "{header}"'
    if quote == '"' and target[:2] == ["docs", "tutorials"]:
        return None if path.startswith("tests/tutorials/") else f'only tests/tutorials may include "{header}"'
    for pattern, files in THIRD_PARTY:
        if fnmatch.fnmatch(header, pattern):
            return None if fits(path, files) else f"{header} is for {' and '.join(files)} only"
    if quote == '"':
        return f'"{header}" is not a path from the root of the repository'
    return None if SYSTEM.fullmatch(header) else f"<{header}> is neither standard nor in the table of tools/check_layers.py"


def wrong_pragma(path, rest):
    if re.match(r"\s*(simd|declare\s+simd)\b", rest) or fits(path, ["core/parallel.hpp", "core/parallel.cpp"]):
        return None
    return "OpenMP is for core/parallel.hpp only (omp simd excepted)"


def check_text(path, text):
    """All findings in one file, as 'path:line: reason'."""
    found = []
    for number, line in enumerate(text.splitlines(), start=1):
        reason = None
        if match := INCLUDE.match(line):
            reason = wrong_include(path, match[1], match[2])
        elif (match := OMP.search(line.split("//")[0])) is not None:
            reason = wrong_pragma(path, match["rest"])
        if reason:
            found.append(f"{path}:{number}: {reason}")
    return found


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
    files = sorted(f for folder in [*BELOW, "tests"] for f in (root / folder).rglob("*") if f.suffix in (".hpp", ".cpp"))
    found = [line for f in files for line in check_text(f.relative_to(root).as_posix(), f.read_text(encoding="utf-8"))]
    print("\n".join(found) if found else f"layers: {len(files)} files, nothing forbidden")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
