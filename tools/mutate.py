#!/usr/bin/python3
"""Mutation testing: changes one operator, sign or number of the sources at a time and runs the tests of the folder.

A change that no test notices (a survivor) shows what the tests do not look at.  All changes of a sample are compiled at once into a copy of
the sources, build/mutants/tree, and chosen there by the environment: TALUS_MUTANT=17 (tools/schemata.py).

    tools/mutate.py                          # a sample of every group
    tools/mutate.py laws walls --sample 40   # 40 changes of each of two groups
    tools/mutate.py laws --list              # what could be changed, nothing is built
    tools/mutate.py --report                 # the table of what was found so far

Results are kept in build/mutants/results.jsonl, a line for each change; what was caught is not tried again.  The sample of a group
depends on --seed and the sources of that group alone, and a larger sample begins with the smaller one.
"""
import argparse
import collections
import concurrent.futures
import dataclasses
import json
import os
import pathlib
import re
import resource
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
import time

from mutants import mutants_of_group, sample
from schemata import HEADER, culprits, schema

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOTES = ROOT / "tools" / "mutants.txt"
HEADER_NAME = "build/talus_mutants.hpp"
# Quick to compile; without asserts, since it is the tests that are tested.  A value cannot stand in for what a reference is made to.
OPTIONS = ("-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", "-DCMAKE_CXX_FLAGS=-Werror=return-local-addr",
           "-DTALUS_UNITY=ON", "-DTALUS_QUICK_TESTS=ON")
LIBRARIES = ("talus_materials", "talus_kernels", "talus_solver", "talus_app")  # a header is seen by its own and those after it
INTERRUPTED = 130  # exit code of a ninja that was
QUICK = 100  # ms
ASKED = 0.9  # share of the changes that the tests have to notice


@dataclasses.dataclass(frozen=True)
class Group:
    """Sources that are changed, and the tests that have to notice: (target, filter of its tests), tried in turn until one fails."""
    sources: tuple
    tests: tuple


ALL = "-*Nightly*"
# What only shows in whole runs: conservation, walls, loads, stages and restarts of small scenes; and the accounts of a run by hand.
OF_THE_PROGRAM = "AccountsByHand.*:Run.*:Stages.*:Restart.*-*Nightly*"
GROUPS = {
    "laws": Group(("materials/*.cpp", "materials/*.hpp"), (("talus_materials_tests", ALL),)),
    "kernels": Group(("kernels/*.cpp", "kernels/*.hpp"), (("talus_kernels_tests", ALL), ("talus_solver_tests", ALL))),
    "transfers": Group(("solver/transfer/*.hpp", "solver/strips/*.hpp", "solver/strips/*.cpp", "solver/state/nodes.hpp", "solver/options/transfer_options.hpp",
                        "solver/boundary/small_mass_nodes.*"),
                       (("talus_solver_tests", ALL), ("talus_app_tests", OF_THE_PROGRAM))),
    "walls": Group(("mesh/conditions/*.hpp", "mesh/conditions/*.cpp", "solver/boundary/boundary_conditions.*", "solver/boundary/dashpots.*", "solver/loads/loads.*"),
                   (("talus_mesh_tests", ALL), ("talus_solver_tests", ALL), ("talus_app_tests", OF_THE_PROGRAM))),
    "balances": Group(("solver/state/ledger.hpp", "solver/state/node_work.hpp", "solver/state/step_sums.hpp", "solver/state/sums.hpp",
                       "app/observers/accounts.*"),
                     (("talus_solver_tests", ALL), ("talus_app_tests", OF_THE_PROGRAM))),
}


class Tree:
    """A copy of the sources with its own build, into which changes are put."""
    most_memory = 12 << 30  # B: a loop that does not end may ask for all there is

    def __init__(self, folder, jobs):
        self.folder, self.build, self.jobs = folder, folder / "build", jobs
        self.usual = {}  # seconds of the tests when nothing is changed
        self.quick = {}  # names of those that take next to no time, for --gtest_filter
        self.sound = set()  # what compiles: a change that is taken out does not alter that
        self.environment = {**os.environ, "OMP_WAIT_POLICY": "passive", "OMP_NUM_THREADS": "1"}

    def fill(self, changed):
        """What is in the tree at hand, with the texts {path: text} in the place of some; what stays as it was need not be compiled again."""
        self.folder.mkdir(parents=True, exist_ok=True)
        names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True,
                               text=True).stdout
        wanted = {n for n in names.split("\0") if n and (ROOT / n).is_file()}
        for old in self.folder.rglob("*.[ch]pp"):
            if self.build not in old.parents and str(old.relative_to(self.folder)) not in wanted:
                old.unlink()
        for name in wanted:
            text, copy = changed[name].encode() if name in changed else (ROOT / name).read_bytes(), self.folder / name
            if not copy.exists() or copy.read_bytes() != text:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(text)
        (self.folder / HEADER_NAME).parent.mkdir(exist_ok=True)
        header = self.folder / HEADER_NAME
        if not header.exists() or header.read_text() != HEADER:
            header.write_text(HEADER)

    def configure(self):
        if not (self.build / "build.ninja").exists():
            subprocess.run(["cmake", "-G", "Ninja", "-S", str(self.folder), "-B", str(self.build), "-Wno-dev", *OPTIONS], check=True,
                           stdout=subprocess.DEVNULL)

    def complaints(self, libraries):
        """What the compiler says of the sources of these libraries without making code of them; of those that were sound before, nothing."""
        subprocess.run(["ninja", "-C", str(self.build), "talus_pch", "talus_version_header"], check=False,
                       stdout=subprocess.DEVNULL)
        entries = json.loads((self.build / "compile_commands.json").read_text())
        commands = []
        for e in entries:
            if e["command"] not in self.sound and any(f"CMakeFiles/{library}.dir/" in e["command"] for library in libraries):
                words = shlex.split(e["command"])
                at = words.index("-o")
                commands.append((e["command"], [*words[:at], *words[at + 2:], "-fsyntax-only", "-fmax-errors=500"]))

        def said_of(command):
            done = subprocess.run(command[1], cwd=self.build, check=False, capture_output=True, text=True)
            if done.returncode == 0:
                self.sound.add(command[0])
            return done.stderr

        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return "\n".join(pool.map(said_of, commands))

    def compile(self, targets):
        """What the compiler says; nothing: it is all there."""
        done = subprocess.run(["ninja", "-k", "0", "-C", str(self.build), f"-j{self.jobs}", *targets], check=False, capture_output=True, text=True)
        if done.returncode < 0 or done.returncode == INTERRUPTED:
            sys.exit(f"the build was ended from outside (exit code {done.returncode})")
        return "" if done.returncode == 0 else done.stdout + done.stderr

    def run(self, number, target, chosen, limit):
        """(whether the tests pass with this change, the first that does not, what they print)."""
        def quietly():
            resource.setrlimit(resource.RLIMIT_AS, (self.most_memory, self.most_memory))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        command = [str(self.build / target), "--gtest_fail_fast", f"--gtest_filter={chosen}"]
        with tempfile.TemporaryFile("w+", errors="replace") as log, subprocess.Popen(
                command, cwd=self.build, env={**self.environment, "TALUS_MUTANT": str(number)}, stdout=log, stderr=log, start_new_session=True,
                preexec_fn=quietly) as child:
            try:
                code = child.wait(limit)
            except subprocess.TimeoutExpired:
                code = None
            finally:
                if child.poll() is None:
                    os.killpg(child.pid, signal.SIGKILL)
            log.seek(0)
            said = log.read()
        failed = re.findall(r"^\[  FAILED  \] ([^\s,]+)", said, re.MULTILINE)[:1] or re.findall(r"^\[ RUN      \] (\S+)", said, re.MULTILINE)[-1:]
        return code == 0, failed[0] if failed else target, said

    def measure(self, tests):
        """The tests as they are have to pass."""
        for target, chosen in tests:
            if (target, chosen) not in self.usual:
                start = time.monotonic()
                passed, test, said = self.run(0, target, chosen, 3600)
                if not passed:
                    sys.exit(f"{target} fails in {self.folder} with nothing changed: {test}")
                self.usual[target, chosen] = time.monotonic() - start
                took = re.findall(r"^\[       OK \] ([^\s,]+).*\((\d+) ms\)$", said, re.MULTILINE)
                self.quick[target, chosen] = [test for test, ms in took if int(ms) <= QUICK]

    def limit(self, target, chosen):
        return 20 + 5 * self.usual[target, chosen]


def judge(number, tests, tree, first):
    """Tries until a test fails, beginning with those that caught changes nearby, {target: names}, and quick ones.  (verdict, by which test)."""
    for target, chosen in tests:
        limit = tree.limit(target, chosen)
        for names in [":".join(some) for some in (first[target], tree.quick[target, chosen]) if some] + [chosen]:
            passed, test, _ = tree.run(number, target, names, limit)
            if not passed:
                if test not in first[target]:
                    first[target].append(test)
                return "caught", f"{target} {test}"
    return "survived", ""


def put_together(tree, numbered, targets, left_out):
    """Writes and builds the tree with all the changes {path: {number: Mutant}} that can be compiled; returns the numbers of the others, of
    which some may be known."""
    most = max(LIBRARIES.index(t.removesuffix("_tests")) for t in targets)
    stage = "compiled" if left_out else "checked"
    while True:
        changed, together = {}, {}
        inside = {path: {n: m for n, m in of_file.items() if n not in left_out} for path, of_file in numbered.items()}
        for path, of_file in inside.items():
            if of_file:
                changed[path], groups = schema((ROOT / path).read_text(), of_file, HEADER_NAME)
                together |= groups
        tree.fill(changed)
        tree.configure()
        said = tree.complaints(LIBRARIES[:most + 1]) if stage == "checked" else tree.compile(targets)
        guilty = culprits(said, inside, together, tree.folder)
        if guilty:
            left_out |= guilty
            print(f"{len(guilty)} of the changes do not compile, {sum(map(len, inside.values())) - len(guilty)} are left", flush=True)
        elif stage == "checked":
            stage = "compiled"
        elif said:
            (tree.folder / "said.log").write_text(said)
            sys.exit(f"does not compile, and by none of the changes: see {tree.folder / 'said.log'}")
        else:
            return left_out


def plan_for(chosen, everything, file):
    """({path: {number: Mutant}}, numbers known not to compile) for the names chosen: the plan of the tree that is there, if it has all of
    them, so that nothing need be compiled again but tests that changed."""
    plan = json.loads(file.read_text()) if file.exists() else {"number": {}, "left_out": []}
    if not (chosen <= plan["number"].keys() <= everything.keys()):
        plan = {"number": {key: n for n, key in enumerate(sorted(chosen), start=1)}, "left_out": []}
    numbered = collections.defaultdict(dict)
    for key, number in plan["number"].items():
        numbered[everything[key].path][number] = everything[key]
    return numbered, set(plan["left_out"])


def keep_plan(numbered, left_out, file):
    file.write_text(json.dumps({"number": {m.key: n for of_file in numbered.values() for n, m in of_file.items()}, "left_out": sorted(left_out)}))


def read_results(file):
    if not file.exists():
        return {}
    return {row["key"]: row for row in map(json.loads, file.read_text().splitlines())}


def read_notes(file):
    """What people found out about survivors: "KEY := words" a line.  Words that begin with "equal" say that the change cannot be seen."""
    notes = {}
    if file.exists():
        for line in file.read_text().splitlines():
            if line and not line.startswith("#"):
                key, _, words = line.partition(" := ")
                notes[key.strip()] = words.strip()
    return notes


def table(results, notes):
    """Markdown: caught and tried of each group, and its survivors with the test that they ask for."""
    rows = collections.defaultdict(list)
    for row in results.values():
        rows[row["group"]].append(row)
    lines = ["| group | tried | caught | equal | survived | share caught | does not compile |", "|---|---|---|---|---|---|---|"]
    survivors = []
    for name in sorted(rows):
        verdicts = collections.Counter(r["verdict"] for r in rows[name])
        left = [r for r in rows[name] if r["verdict"] == "survived"]
        equal = [r for r in left if notes.get(r["key"], "").startswith("equal")]
        tried = verdicts["caught"] + len(left)
        judged = tried - len(equal)
        share = f"{100 * verdicts['caught'] / judged:.0f} %" if judged else "-"
        lines.append(f"| {name} | {tried} | {verdicts['caught']} | {len(equal)} | {len(left) - len(equal)} | {share} | {verdicts['does not compile']} |")
        survivors += sorted((r for r in left if r not in equal), key=lambda r: (r["path"], r["line"]))
    lines += ["", "| survivor | change | the test it asks for |", "|---|---|---|"]
    for r in survivors:
        code, change = (words.replace("|", "\\|") for words in (r["text"], f"{r['old'].strip()} -> {r['new'].strip() or 'nothing'}"))
        lines.append(f"| `{r['path']}:{r['line']}` `{code}` | `{change}` | {notes.get(r['key'], 'not looked at yet')} |")
    return "\n".join(lines) + "\n"


def missed(results, notes):
    """Groups of which too few changes were caught."""
    caught, judged = collections.Counter(), collections.Counter()
    for r in results.values():
        if r["verdict"] != "does not compile" and not (r["verdict"] == "survived" and notes.get(r["key"], "").startswith("equal")):
            judged[r["group"]] += 1
            caught[r["group"]] += r["verdict"] == "caught"
    return [name for name in sorted(judged) if caught[name] < ASKED * judged[name]]


def try_all(names, options):
    """Samples of the groups, all of them in one tree."""
    known = {key for key, row in read_results(options.results).items() if row["verdict"] != "survived"}
    everything, group_of, chosen = {}, {}, set()
    for name, group in GROUPS.items():
        of_group = mutants_of_group(ROOT, group.sources)
        everything |= {m.key: m for m in of_group}
        group_of |= {m.key: name for m in of_group}
        if name in names:
            considered = [m for m in of_group if not options.only or options.only in m.key]
            chosen |= {m.key for m in sample(name, considered, options.sample, options.seed)} - known
    if not chosen:
        return
    tests = {name: tuple(t for t in GROUPS[name].tests if options.program or t[0] != "talus_app_tests") for name in {group_of[key] for key in chosen}}
    tree = Tree((options.results.parent / "tree").resolve(), options.jobs)
    plan = options.results.parent / "plan.json"
    numbered, left_out = plan_for(chosen, everything, plan)
    left_out = put_together(tree, numbered, sorted({target for of in tests.values() for target, _ in of}), left_out)
    keep_plan(numbered, left_out, plan)
    for of in tests.values():
        tree.measure(of)
    print("seconds of the tests with nothing changed:", ", ".join(f"{t} {s:.0f}" for (t, _), s in tree.usual.items()), flush=True)
    first = collections.defaultdict(lambda: collections.defaultdict(list))
    writing = threading.Lock()

    def tried(number, m):
        name = group_of[m.key]
        verdict, by = ("does not compile", "") if number in left_out else judge(number, tests[name], tree, first[m.path])
        row = {"group": name, "key": m.key, "verdict": verdict, "by": by, **dataclasses.asdict(m)}
        with writing, open(options.results, "a") as file:
            file.write(json.dumps(row) + "\n")
            print(f"{verdict:16} {m.path}:{m.line}: {m.change}    {m.text}    {by}", flush=True)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for done in [pool.submit(tried, n, m) for of_file in numbered.values() for n, m in of_file.items() if m.key in chosen]:
            done.result()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)}; default all")
    parser.add_argument("--sample", type=int, default=60, help="changes of each group, default 60")
    parser.add_argument("--seed", type=int, default=1, help="another seed is another sample")
    parser.add_argument("--only", help="only changes whose name, PATH: LINE : OLD -> NEW, has this in it")
    parser.add_argument("--program", action="store_true", help="what the tests of the folders let pass is tried on those of the program, too")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers, and changes that are tried, at a time")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "build" / "mutants" / "results.jsonl")
    parser.add_argument("--list", action="store_true", help="only say what could be changed")
    parser.add_argument("--report", action="store_true", help="only write the table of what was found")
    options = parser.parse_args()
    for name in options.groups:
        if name not in GROUPS:
            parser.error(f"no group '{name}': {', '.join(GROUPS)}")
    names = options.groups or list(GROUPS)
    if options.list:
        for name in names:
            everything = [m for m in mutants_of_group(ROOT, GROUPS[name].sources) if not options.only or options.only in m.key]
            print(f"{name}: {len(everything)} changes")
            for m in everything:
                print(f"  {m.path}:{m.line}: {m.change}    {m.text}")
        return 0
    if not options.report:
        options.results.parent.mkdir(parents=True, exist_ok=True)
        try_all(names, options)
    results, notes = read_results(options.results), read_notes(NOTES)
    print(table(results, notes), end="")
    return 1 if not options.report and missed(results, notes) else 0


if __name__ == "__main__":
    sys.exit(main())
