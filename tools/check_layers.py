#!/usr/bin/python3
"""Fails on any include that the layers forbid: a folder includes what its README.md names, in no circle; a third-party header has its own files.

Also fails on a folder without README.md or with more than 40 files, on a header name that occurs twice, and on a source file, in whatever
language, of more than 400 lines.

Usage: check_layers.py [root]      prints file:line: what is wrong, one a line; exit status 1 if there was any.
"""
import fnmatch
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOP = ("core", "mesh", "kernels", "materials", "solver", "io", "app")
MOST_FILES = 40
MOST_LINES = 400
WRITTEN_IN = {".cpp", ".hpp", ".py", ".sh", ".cmake", ".mjs", ".js", ".css"}
KEPT_OUT = {"build", "node_modules", ".git"}  # folders without sources of ours
MAY_INCLUDE = re.compile(r"^May include: (.*)\.$", re.MULTILINE)


def folders_of(root):
    """{folder: folders it may include}, as the README.md of each folder with sources says."""
    table = {}
    for readme in sorted(f for top in TOP for f in (root / top).rglob("README.md")):
        if line := MAY_INCLUDE.search(readme.read_text(encoding="utf-8")):
            table[readme.parent.relative_to(root).as_posix()] = [] if line[1] == "nothing" else line[1].split(", ")
    return table


FOLDERS = folders_of(ROOT)
# The folders that tests of a folder may include: itself and those below it.
TESTS_SEE = {"core": ["core"], "mesh": ["core", "mesh"], "kernels": ["core", "mesh", "kernels"], "materials": ["core", "materials"],
             "solver": ["core", "mesh", "kernels", "materials", "solver"], "io": ["core", "mesh", "kernels", "materials", "solver", "io"], "app": TOP,
             "fuzz": TOP, "tutorials": ["core", "mesh", "kernels", "materials", "solver"], "ranks": TOP, "speed": ["core", "mesh", "kernels", "materials", "solver"]}

# header pattern, files that may include it; tests/io/output/run_summary_test.cpp may include what io/output/run_summary.cpp may. The first match decides.
THIRD_PARTY = [
    ("Eigen/*", ["*"]),
    ("fmt/*", ["*"]),
    ("omp.h", ["core/parallel/threads.hpp"]),
    ("malloc.h", ["io/system/memory.cpp"]),
    ("mpi.h", ["core/parallel/mpi_calls.hpp"]),
    ("immintrin.h", ["core/simd.hpp"]),
    ("metis.h", ["mesh/partition.cpp"]),
    ("yaml-cpp/*", ["io/scene/reader.cpp"]),
    ("gmsh.h*", ["io/mesh/gmsh_*.cpp", "tests/io/load_mesh_test.cpp"]),
    ("petsc*", ["io/equations/petsc_solver.cpp"]),
    ("pybind11/*", ["io/python/embedded_*"]),
    ("gdal*", ["io/terrain/gdal_*"]),
    ("ogr_*", ["io/terrain/gdal_*"]),
    ("cpl_*", ["io/terrain/gdal_*"]),
    ("vtk*", ["io/output/vtk*.cpp", "io/pictures/*render_*"]),
    ("nlohmann/*", ["io/*json*.cpp", "io/output/run_summary.cpp", "io/scene/manual/scene_schema.cpp", "tests/io/scene/manual/*_test.cpp", "tests/io/page/page_test.cpp"]),
    ("hdf5.h", ["io/checkpoint/hdf5*", "io/checkpoint/array_*.cpp"]),
    ("zlib.h", ["io/page/page_block.cpp", "tests/io/page/page_test.cpp"]),
    ("CLI/*", ["app/cli/cli*", "io/pictures/settings/option_parser.hpp"]),
    ("muParser*", ["app/setup/expression.cpp"]),
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
    """The reason why this file may not include this header, or None."""
    parts, target = path.split("/"), header.split("/")
    if ".." in target:
        return f'"{header}" climbs out of its folder: write the path from the root of the repository'
    if len(target) > 1 and target[0] in TOP and quote == '"':
        if parts[0] == "tests":
            return None if target[0] in TESTS_SEE.get(parts[1], []) else f'{"/".join(parts[:2])} may not include {target[0]} ("{header}")'
        folder, other = "/".join(parts[:-1]), "/".join(target[:-1])
        return None if other == folder or other in FOLDERS.get(folder, []) else f'{folder} may not include {other} ("{header}"): {folder}/README.md says what it may'
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
    if re.match(r"\s*(simd|declare\s+simd)\b", rest) or fits(path, ["core/parallel/threads.hpp"]):
        return None
    return "OpenMP is for core/parallel/threads.hpp only (omp simd excepted)"


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


def check_length(path, text):
    """A finding if a source file is too long."""
    lines = text.count("\n")
    return [f"{path}: {lines} lines, more than {MOST_LINES}: give each duty a file of its own"] if lines > MOST_LINES else []


def written_files(root):
    """All hand-written files of the tree in a language of WRITTEN_IN."""
    for folder in sorted(f for f in root.iterdir() if f.is_dir() and f.name not in KEPT_OUT):
        yield from sorted(f for f in folder.rglob("*") if f.suffix in WRITTEN_IN and not KEPT_OUT & set(f.relative_to(root).parts))


def circle_in(table):
    """Folders that include each other in a circle, or []."""
    done, path = set(), []

    def visit(folder):
        if folder in path:
            return path[path.index(folder):] + [folder]
        if folder in done:
            return []
        path.append(folder)
        for other in table.get(folder, []):
            if found := visit(other):
                return found
        path.pop()
        done.add(folder)
        return []

    for folder in table:
        if found := visit(folder):
            return found
    return []


def check_folders(table, files):
    """Findings on the folders of these source files (paths from the root) and on what the table {folder: may include} says."""
    found, sources, headers = [], {}, {}
    for path in files:
        folder, _, name = path.rpartition("/")
        sources.setdefault(folder, []).append(name)
        if name.endswith(".hpp") and not path.startswith("tests/"):
            headers.setdefault(name, []).append(path)
    for folder, names in sorted(sources.items()):
        if len(names) > MOST_FILES:
            found.append(f"{folder}: {len(names)} source files, more than {MOST_FILES}: give it sub-folders")
        if folder.split("/")[0] in TOP and folder not in table:
            found.append(f"{folder}: there is no README.md that says what the folder is for and 'May include: ...'")
    found += [f"{' and '.join(paths)}: the same name twice" for paths in headers.values() if len(paths) > 1]
    found += [f"{folder}/README.md: there is no folder {other}" for folder, others in table.items() for other in others if other not in sources]
    found += [f"{folder}/README.md: there are no sources in {folder}" for folder in table if folder not in sources]
    if circle := circle_in(table):
        found.append(f"folders include each other in a circle: {' -> '.join(circle)}")
    return found


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT)
    files = sorted(f for folder in [*TOP, "tests"] for f in (root / folder).rglob("*") if f.suffix in (".hpp", ".cpp"))
    paths = [f.relative_to(root).as_posix() for f in files]
    found = check_folders(folders_of(root), paths)
    found += [line for path, f in zip(paths, files) for line in check_text(path, f.read_text(encoding="utf-8"))]
    found += [line for f in written_files(root) for line in check_length(f.relative_to(root).as_posix(), f.read_text(encoding="utf-8"))]
    print("\n".join(found) if found else f"layers: {len(files)} files, nothing forbidden")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
