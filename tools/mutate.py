#!/usr/bin/python3
"""Mutation testing: changes one operator, sign or number of the sources at a time and runs the tests of the folder.

A change that no test notices (a survivor) shows what the tests do not look at.  The sources are changed in a tree of their own, never in
the one at hand: `--tree` names a clone with a finished build (preset dev, TALUS_UNITY=OFF), by default build/mutants/tree, which is made.

    tools/mutate.py                          # a sample of every group: hours
    tools/mutate.py laws walls --sample 40   # 40 changes of each of two groups
    tools/mutate.py laws --list              # what could be changed, nothing is built
    tools/mutate.py --report                 # the table of what was found so far

Results are kept in build/mutants/results.jsonl, a line for each change; what stands there is not tried again.  The sample of a group
depends on --seed and the sources of that group alone, and a larger sample begins with the smaller one.
"""
import argparse
import collections
import dataclasses
import json
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
NOTES = ROOT / "tools" / "mutants.txt"
INTERRUPTED = 130  # exit code of a ninja that was
ASKED = 0.9  # share of the changes that the tests have to notice


@dataclasses.dataclass(frozen=True)
class Group:
    """Sources that are changed, and the tests that have to notice: (target, filter of its tests), tried in turn until one fails."""
    sources: tuple
    tests: tuple


ALL = "-*Nightly*"
# What only shows in whole runs: conservation, walls, loads, stages and restarts of small scenes.
OF_THE_PROGRAM = "Run.*:Stages.*:Restart.*-*Nightly*"
GROUPS = {
    "laws": Group(("materials/*.cpp", "materials/*.hpp"), (("talus_materials_tests", ALL),)),
    "kernels": Group(("kernels/*.cpp", "kernels/*.hpp"), (("talus_kernels_tests", ALL), ("talus_solver_tests", ALL))),
    "transfers": Group(("solver/scatter.hpp", "solver/gather.hpp", "solver/through_*.hpp", "solver/hats.hpp", "solver/deposit.hpp",
                        "solver/nodes.hpp", "solver/transfer.hpp", "solver/slaves.*"),
                       (("talus_solver_tests", ALL), ("talus_app_tests", OF_THE_PROGRAM))),
    "walls": Group(("solver/walls.*", "solver/loads.*"), (("talus_solver_tests", ALL), ("talus_app_tests", OF_THE_PROGRAM))),
    "balances": Group(("solver/ledger.hpp", "solver/tally.hpp", "solver/sums.hpp", "app/accounts.*"),
                     (("talus_solver_tests", ALL), ("talus_app_tests", OF_THE_PROGRAM))),
}


@dataclasses.dataclass(frozen=True)
class Mutant:
    """Bytes [begin, end) of a file replaced by others."""
    path: str
    begin: int
    end: int
    old: str
    new: str
    line: int   # from 1
    text: str   # of the line, as it was
    place: int = 1  # among equal changes of equal lines of the file

    @property
    def key(self):
        """What it is called from one version of the sources to the next: no number of a line."""
        return f"{self.path}: {self.text} : {self.change}" + (f" #{self.place}" if self.place > 1 else "")

    @property
    def change(self):
        return f"{self.old.strip()} -> {self.new.strip() or 'nothing'}"

    def apply(self, source):
        return source[:self.begin] + self.new + source[self.end:]


def code_only(source):
    """The source with comments, texts, characters and preprocessor lines blanked out, every other character in its place."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])*\'|^[ \t]*#[^\n]*', re.DOTALL | re.MULTILINE)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), source)


# The formatter puts blanks around operators of two operands and nowhere else, so that `a < b` is a comparison and `array<T>` is none.
OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
             "<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "==", "&&": "||", "||": "&&"}
TWO_OPERANDS = re.compile(r"(?<=[\w)\]}] )(?:[-+*/]=?|[<>]=?|[=!]=|&&|\|\|)(?=\s)")
LEADING_OPERATOR = re.compile(r"(?<=\n)(?P<blank>[ ]+)(?P<operator>[-+*/]|&&|\|\|)(?= )")
MINUS = re.compile(r"(?:(?<=[(,={?:<>*/+] )|(?<=[({\[])|(?<=return ))-(?=[\w(])")
NOT = re.compile(r"!(?=[\w(])")
MIN_MAX = re.compile(r"\b(?:min|max)(?=\()")
TRUTH = re.compile(r"\b(?:true|false)\b")
REAL = re.compile(r"(?<![\w.])(?:\d+\.\d+(?:e[-+]?\d+)?|\d+e[-+]?\d+)(?![\w.])")
INTEGER = re.compile(r"(?<![\w.])\d+(?= [-+*/] )|(?<= [*/] )\d+(?![\w.'])")
# The value of a whole expression, one per cent too large: what tests have a number for they must have to better than that.
VALUE = re.compile(r"(?:\b(?:Real|T) \w+ = |\breturn )(?P<value>[^;{}?\n]+)(?=;)")
NO_NUMBER = re.compile(r"[<>=!]=|&&|\|\||[^-]>(?!\()| < | = |!|\b(?:true|false|none|nullptr|std::move)\b|\b(?:is|has|can|are|everywhere|somewhere)(?:_\w+)?\b|\*this|\"")
NOT_JUDGED = re.compile(r"\b(?:static_assert|assert|throw)\b")
SMALLEST = 1e-6  # numbers below are tolerances: no test has to know them to a per cent
BY = 1.01


def scaled(literal):
    return f"{float(literal) * BY:.12g}"


def finds(code):
    """(begin, end, new) of every change of a source that was blanked by code_only."""
    for m in TWO_OPERANDS.finditer(code):
        yield m.start(), m.end(), OPERATORS[m.group()]
    for m in LEADING_OPERATOR.finditer(code):
        yield m.start("operator"), m.end("operator"), OPERATORS[m.group("operator")]
    for pattern in (MINUS, NOT):
        for m in pattern.finditer(code):
            yield m.start(), m.end(), ""
    for m in MIN_MAX.finditer(code):
        yield m.start(), m.end(), {"min": "max", "max": "min"}[m.group()]
    for m in TRUTH.finditer(code):
        yield m.start(), m.end(), {"true": "false", "false": "true"}[m.group()]
    for m in REAL.finditer(code):
        if abs(float(m.group())) >= SMALLEST:
            yield m.start(), m.end(), scaled(m.group())
    for m in INTEGER.finditer(code):
        yield m.start(), m.end(), str(int(m.group()) + 1)
    for m in VALUE.finditer(code):
        value = m.group("value")
        if not NO_NUMBER.search(value) and not re.fullmatch(r"[\s\d.]+", value):
            yield m.start("value"), m.end("value"), f"{BY} * ({value})"


def mutants_of(path, source):
    """Every change of one source, in the order of its characters."""
    found = []
    times = collections.Counter()
    for begin, end, new in sorted(set(finds(code_only(source)))):
        line_begin = source.rfind("\n", 0, begin) + 1
        line_end = source.find("\n", begin)
        text = source[line_begin:line_end if line_end >= 0 else len(source)]
        if not NOT_JUDGED.search(text):
            old = source[begin:end]
            if new.startswith(f"{BY} * ("):
                new = f"{BY} * ({old})"   # with its texts, which code_only left out
            times[text.strip(), old, new] += 1
            found.append(Mutant(path, begin, end, old, new, source.count("\n", 0, begin) + 1, text.strip(), times[text.strip(), old, new]))
    return found


def mutants_of_group(root, group):
    paths = sorted({p for pattern in group.sources for p in root.glob(pattern)})
    return [m for p in paths for m in mutants_of(str(p.relative_to(root)), p.read_text())]


def sample(name, mutants, size, seed):
    """A larger sample begins with the smaller one."""
    order = list(mutants)
    random.Random(f"{seed}:{name}").shuffle(order)
    return order[:size]


def judge(mutant, tree, tests, build, test):
    """Makes the change in the tree, builds and tries until a test fails, and takes the change back.  (verdict, by whom):
    "caught", "survived", or "does not compile", which says nothing about the tests."""
    file = tree / mutant.path
    source = file.read_text()
    assert source[mutant.begin:mutant.end] == mutant.old, f"{mutant.path} is not what was sampled"
    try:
        file.write_text(mutant.apply(source))
        for target, chosen in tests:
            if not build(target):
                return "does not compile", target
            if not test(target, chosen):
                return "caught", target
        return "survived", ""
    finally:
        file.write_text(source)


class Trial:
    """The build of a tree and the tests in it."""
    most_memory = 12 << 30  # B: a loop that does not end may ask for all there is

    def __init__(self, tree, build, jobs, log):
        self.tree, self.folder, self.jobs, self.log = tree, tree / build, jobs, log
        self.usual = {}  # seconds of the tests when nothing is changed
        self.environment = {**os.environ, "OMP_WAIT_POLICY": "passive", "OMP_NUM_THREADS": "1"}

    def run(self, command, limit):
        """Exit code; None: it took too long."""
        def quietly():
            resource.setrlimit(resource.RLIMIT_AS, (self.most_memory, self.most_memory))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        with open(self.log, "w") as log, subprocess.Popen(command, cwd=self.tree, env=self.environment, stdout=log, stderr=log,
                                                          start_new_session=True, preexec_fn=quietly) as child:
            try:
                return child.wait(limit)
            except subprocess.TimeoutExpired:
                return None
            finally:
                if child.poll() is None:
                    os.killpg(child.pid, signal.SIGKILL)

    def build(self, target):
        wanted = [target] if target != "talus_app_tests" else ["talus", target]
        code = self.run(["ninja", "-C", str(self.folder), f"-j{self.jobs}", *wanted], None)
        if code < 0 or code == INTERRUPTED:
            sys.exit(f"the build was ended from outside (exit code {code}): nothing is known of the change at hand")
        return code == 0

    def test(self, target, chosen):
        limit = 60 + 10 * self.usual[target, chosen] if (target, chosen) in self.usual else 3600
        return self.run([str(self.folder / target), "--gtest_fail_fast", "--gtest_brief=1", f"--gtest_filter={chosen}"], limit) == 0

    def measure(self, tests):
        """The tests as they are have to pass."""
        for target, chosen in tests:
            if (target, chosen) in self.usual:
                continue
            if not self.build(target):
                sys.exit(f"{target} does not compile in {self.tree}: see {self.log}")
            start = time.monotonic()
            if not self.test(target, chosen):
                sys.exit(f"{target} fails in {self.tree} with nothing changed: see {self.log}")
            self.usual[target, chosen] = time.monotonic() - start


def make_tree(tree):
    """A clone of what is committed here, with a build of its own."""
    if not (tree / ".git").exists():
        subprocess.run(["git", "clone", "--quiet", str(ROOT), str(tree)], check=True)
        subprocess.run(["cmake", "--preset", "dev", "-D", "TALUS_UNITY=OFF", "-Wno-dev"], cwd=tree, check=True, stdout=subprocess.DEVNULL)


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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)}; default all")
    parser.add_argument("--sample", type=int, default=60, help="changes of each group, default 60")
    parser.add_argument("--seed", type=int, default=1, help="another seed is another sample")
    parser.add_argument("--only", help="only files whose path has this in it")
    parser.add_argument("--tree", type=pathlib.Path, help="a clone with a build, whose sources are changed")
    parser.add_argument("--build", default="build/dev", help="its build, below the tree")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers at a time")
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "build" / "mutants" / "results.jsonl")
    parser.add_argument("--list", action="store_true", help="only say what could be changed")
    parser.add_argument("--report", action="store_true", help="only write the table of what was found")
    options = parser.parse_args()
    for name in options.groups:
        if name not in GROUPS:
            parser.error(f"no group '{name}': {', '.join(GROUPS)}")
    notes = read_notes(NOTES)
    if options.report:
        print(table(read_results(options.results), notes), end="")
        return 0

    tree = (options.tree or ROOT / "build" / "mutants" / "tree").resolve()
    if tree == ROOT and not options.list:
        parser.error("--tree must be a clone: its sources are changed")
    if options.list:
        tree = ROOT
    else:
        options.results.parent.mkdir(parents=True, exist_ok=True)
        make_tree(tree)
    trial = Trial(tree, options.build, options.jobs, options.results.parent / "last.log")
    for name in options.groups or GROUPS:
        group = GROUPS[name]
        everything = [m for m in mutants_of_group(tree, group) if not options.only or options.only in m.path]
        if options.list:
            print(f"{name}: {len(everything)} changes")
            for m in everything:
                print(f"  {m.path}:{m.line}: {m.change}    {m.text}")
            continue
        known = read_results(options.results)
        chosen = [m for m in sample(name, everything, options.sample, options.seed) if m.key not in known]
        if chosen:
            trial.measure(group.tests)
        for m in sorted(chosen, key=lambda one: one.path):  # changes of one file follow each other: the rest is compiled already
            verdict, by = judge(m, tree, group.tests, trial.build, trial.test)
            row = {"group": name, "key": m.key, "verdict": verdict, "by": by, **dataclasses.asdict(m)}
            with open(options.results, "a") as file:
                file.write(json.dumps(row) + "\n")
            print(f"{verdict:16} {m.path}:{m.line}: {m.change}    {m.text}", flush=True)
    if options.list:
        return 0
    results = read_results(options.results)
    print(table(results, notes), end="")
    return 1 if missed(results, notes) else 0


if __name__ == "__main__":
    sys.exit(main())
