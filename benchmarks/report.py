"""Writes the results of the benchmarks: results.json, docs/verification.md and the block in README.md between its markers."""
import json

from lab import ROOT

BEGIN, END = "<!-- verification:begin -->", "<!-- verification:end -->"
VERDICTS = {True: "pass", False: "**FAIL**", None: "-"}


def number(value):
    """Four digits, or a dash for nothing."""
    return "-" if value is None else f"{value:.4g}"


def quantity(result):
    """The value with its unit, if it has one."""
    return number(result.value) + ("" if result.unit == "-" else f" {result.unit}")


def criterion(result):
    """What was asked, in words."""
    if result.criterion == "reported":
        return "reported only"
    if result.criterion == "within":
        return f"within {result.tolerance * 100:.3g} % of reference"
    if result.criterion == "near":
        return f"within {number(result.tolerance)} of reference"
    return f"{result.criterion} {number(result.tolerance)}"


def line(result):
    """One result as a line for the terminal."""
    verdict = VERDICTS[result.passed].strip("*")
    return f"{verdict:5s} {result.metric}: {quantity(result)} (reference {number(result.reference)}; {criterion(result)})"


def table(results):
    """All numbers of some results as a Markdown table."""
    rows = ["| measured | value | unit | reference | asked | verdict | cells | particles | s |", "|---|---|---|---|---|---|---|---|---|"]
    for r in results:
        rows.append(f"| {r.metric} | {number(r.value)} | {r.unit} | {number(r.reference)} | {criterion(r)} | {VERDICTS[r.passed]} "
                    f"| {r.run.cells} | {r.run.particles} | {number(r.run.seconds)} |")
    return rows


def by_case(results):
    """Results grouped by case in their order."""
    groups = {}
    for result in results:
        groups.setdefault(result.case, []).append(result)
    return groups


def title(case):
    """The first line of the case's README.md, without the marks."""
    return (ROOT / "benchmarks" / case / "README.md").read_text(encoding="utf-8").splitlines()[0].lstrip("# ")


def page(results, lab):
    """docs/verification.md as text."""
    program = results[0].run.summary["program"]
    failed = sum(r.passed is False for r in results)
    lines = ["# Verification", "",
             "Written by `make verify`; do not edit. Every number is measured by running the built program on the scene of the benchmark.", "",
             f"Program {program['version']}, commit {program['commit']}, {program['compiler']}; level `{lab.level}`, {lab.threads} thread(s). "
             f"{len(results)} numbers, {sum(r.passed is True for r in results)} passed, {failed} failed, the others are reported without a verdict.", "",
             "Seconds are processor time of the run the number comes from, on whatever machine this was; cells and particles are those of that run."]
    for case, own in by_case(results).items():
        lines += ["", f"## {title(case)}", "", f"Problem, sources and what is measured: [benchmarks/{case}](../benchmarks/{case}/README.md).", ""]
        lines += [*table(own), "", f"References: {'; '.join(dict.fromkeys(r.source for r in own if r.source))}."]
        for name, caption in lab.figures.get(case, []):
            lines += ["", f"![{caption}](images/{name})", "", caption]
    return "\n".join(lines) + "\n"


def summary(results, case):
    """One row for README.md: the first number of a case that is judged, and how many of those passed."""
    judged = [r for r in results if r.passed is not None]
    example = judged[0]
    return (f"| [{title(case)}](benchmarks/{case}/README.md) | {example.metric} | {quantity(example)} | "
            f"{number(example.reference)} | {criterion(example)} | {sum(r.passed is True for r in judged)} of {len(judged)} |")


def block(results):
    """The table for README.md."""
    rows = ["| benchmark | for example | measured | reference | asked | passed |", "|---|---|---|---|---|---|"]
    rows += [summary(own, case) for case, own in by_case(results).items()]
    commit = results[0].run.summary["program"]["commit"]
    return "\n".join([*rows, "", f"Measured at commit {commit}. All numbers, also those that are not good: [docs/verification.md](docs/verification.md)."])


def replace_block(text, content):
    """`text` with what is between the markers replaced, or None where they are not there exactly once in order."""
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        return None
    return f"{text.split(BEGIN)[0]}{BEGIN}\n{content}\n{END}{text.split(END)[1]}"


def write(results, lab):
    """Writes all three."""
    records = json.dumps([result.record() for result in results], indent=1)
    (ROOT / "benchmarks/results.json").write_text(records + "\n", encoding="utf-8")
    (ROOT / "docs/verification.md").write_text(page(results, lab), encoding="utf-8")
    readme = ROOT / "README.md"
    if readme.exists():
        text = replace_block(readme.read_text(encoding="utf-8"), block(results))
        if text is not None:
            readme.write_text(text, encoding="utf-8")
