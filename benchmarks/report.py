#!/usr/bin/python3
"""Writes benchmarks/results.json, docs/development/verification.md with its figures and the block in README.md from the verify.json of a run of the suite.

Usage: benchmarks/report.py OUT/verify.json     cases that were not run stay as they are in benchmarks/results.json
"""
import json
import pathlib
import shutil
import sys

from lab import METHODS, ROOT

DEFAULT_KERNEL = next(iter(METHODS.values()))["kernel"]
BEGIN, END = "<!-- verification:begin -->", "<!-- verification:end -->"
VERDICTS = {True: "pass", False: "**FAIL**", None: "-"}
RESULTS = ROOT / "benchmarks/results.json"
README_ROWS = [  # case, metric, whether its reference is analytic or published (measured, or computed by others): twelve at most
    ("vibrating_bar", "order of convergence, projected, aflip, v0 = 0.001 m/s", "analytic"),
    ("self_weight_column", "settlement of the top, neo_hookean, projected, aflip", "analytic"),
    ("sliding_block", "distance slid, friction 0.5, projected, aflip", "analytic"),
    ("shock", "speed of the shock, neo_hookean, piston at 0.1 c_L", "analytic"),
    ("manufactured_solution", "order of convergence, square, projected, G = 0.1 m", "analytic"),
    ("hertz_contact", "largest force over Hertz's, cells of 0.12 m, projected, aflip", "analytic"),
    ("cantilever", "first largest deflection, thick beam, cells of 0.25 m, projected, aflip", "published"),
    ("colliding_disks", "rebound speed over approach speed, projected, aflip", "published"),
    ("strip_footing", "load over a c, averaged", "analytic"),
    ("factor_of_safety", "factor of safety, Griffiths & Lane, mohr_coulomb, cells of 2 m", "published"),
    ("slope_failure_2d", "toe of the debris, peak, projected, aflip", "published"),
    ("column_collapse", "x at height 1 cm, drucker_prager, projected, aflip", "published"),
]


def number(value):
    """The number with four digits, or a dash for None."""
    return "-" if value is None else f"{value:.4g}"


def quantity(record):
    """The value with its unit, if it has one."""
    return number(record["value"]) + ("" if record["unit"] == "-" else f" {record['unit']}")


def criterion(record):
    """The criterion of a result in words."""
    kind, tolerance = record["criterion"], record["tolerance"]
    if kind == "within":
        return f"within {tolerance * 100:.3g} % of reference"
    if kind == "near":
        return f"within {number(tolerance)} of reference"
    return {"reported": "reported only", "runs": "runs to the end"}.get(kind) or f"{kind} {number(tolerance)}"


def line(record):
    """One result as a line of text for the terminal."""
    verdict = VERDICTS[record["pass"]].strip("*")
    words = record.get("error") or f"{quantity(record)} (reference {number(record['reference'])}; {criterion(record)})"
    note = "".join(f" [{words}]" for words in ("known shortfall" if record.get("known") and record["pass"] is False else "", record.get("changed")) if words)
    return f"{verdict:5s} {record['metric']}: {words}{note}"


def table(records):
    """A Markdown table of results."""
    rows = ["| measured | value | unit | reference | criterion | verdict | cells | particles | s |", "|---|---|---|---|---|---|---|---|---|"]
    for r in records:
        rows.append(f"| {r['metric']} | {number(r['value'])} | {r['unit']} | {number(r['reference'])} | {criterion(r)} | {VERDICTS[r['pass']]} "
                    f"| {(r['mesh'] or '-').split()[0]} | {r['particles'] or '-'} | {number(r['processor_seconds'])} |")
    return rows


def orders(convergence):
    """A Markdown table of errors over sizes of cells, with the order between neighbouring sizes."""
    steps = ["-"] + [f"{number(order)}" for order in convergence["orders"]]
    wanted = "" if convergence["expected"] is None else f" (expected {convergence['expected']:g})"
    return [f"{convergence['name'].capitalize()}: order {number(convergence['order'])} by least squares{wanted}.", "", "| cell size [m] | error | order |",
            "|---|---|---|", *(f"| {size:g} | {number(error)} | {step} |" for size, error, step in zip(convergence["sizes"], convergence["errors"], steps))]


def of(document, part, case):
    """The entries of a part of the document that belong to a case."""
    return [entry for entry in document[part] if entry["case"] == case]


def counts(records):
    """The numbers of results with a criterion, and of those that passed."""
    return sum(r["pass"] is not None for r in records), sum(r["pass"] is True for r in records)


def section(document, info):
    """The section of one case in docs/development/verification.md."""
    case, records = info["case"], of(document, "results", info["case"])
    lines = ["", f"## {info['title']}", "", f"Problem, sources and measured quantities: [benchmarks/{case}](../../benchmarks/{case}/README.md).",
             f"Commit {info['program']['commit']}, level `{info['level']}`, {info['processor_seconds']:.0f} s of processor time in total.", "", *table(records), "",
             f"References: {'; '.join(dict.fromkeys(r['source'] for r in records if r['source']))}."]
    lines += [f"\n{r['metric']}: {r['error']}" for r in records if "error" in r]
    for convergence in of(document, "convergence", case):
        lines += ["", *orders(convergence)]
    for figure in of(document, "figures", case):
        if figure["shown"] == "everywhere":
            lines += ["", f"![{figure['caption']}](../images/{figure['file']})", "", figure["caption"]]
    return lines + price(case)


def price(case):
    """The price of accuracy, where `talus tradeoff` was run for the documents."""
    path = ROOT / "benchmarks" / case / "tradeoff.json"
    if not path.exists():
        return []
    swept = json.loads(path.read_text(encoding="utf-8"))
    return ["", f"![Error over processor time and memory](../images/{swept['figure']})", "", f"Price of accuracy: {swept['what']}, commit {swept['commit']}.", "",
            *(f"* {advice}" for advice in swept["advice"])]


def first_price(cases):
    """The figure of the first case that was swept, for README.md."""
    for case in cases:
        if lines := price(case):
            return [lines[1].replace("](../images/", "](docs/images/"), "", f"{lines[3]}", f"Rings mark the Pareto-optimal choices: no other is better in both (`talus tradeoff {case}`).", *lines[4:]]
    return []


def page(document):
    """The text of docs/development/verification.md."""
    records = document["results"]
    programs = list(dict.fromkeys(f"{c['program']['version']} ({c['program']['compiler']})" for c in document["cases"]))
    judged, passed = counts(records)
    lines = ["# Verification", "",
             "This page compares results of Talus with exact solutions, published results and experiments.",
             "Each number is measured by running the program on the scene of the benchmark:", "[how to run and add benchmarks](benchmarks.md).",
             "The page is written by `tools/verify.sh --write-docs`; do not edit it.", "",
             f"Program {', '.join(programs)}. Of {len(records)} numbers {passed} passed and {judged - passed} failed; the others are reported without a verdict.", "",
             "`cells`, `particles` and `s` (processor time in seconds) are those of the run that the number comes from.",
             "Times of different commits may come from different machines."]
    for info in document["cases"]:
        lines += section(document, info)
    return "\n".join(lines) + "\n"


def row(document, case, metric, kind):
    """One row for README.md; raises ValueError if the suite no longer measures it."""
    info = next((info for info in document["cases"] if info["case"] == case), None)
    record = next((r for r in of(document, "results", case) if r["metric"] == metric), None)
    if record is None:
        raise ValueError(f"README.md shows {metric} of {case}, which was not measured: mend README_ROWS in benchmarks/report.py")
    columns = {kind: number(record["reference"])}
    what = metric.split(", projected")[0] + ("" if record["kernel"] == DEFAULT_KERNEL else f", kernel {record['kernel']}")
    return (f"| [{info['title']}](benchmarks/{case}/README.md) | {what} | {quantity(record)} | {columns.get('analytic', '-')} "
            f"| {columns.get('published', '-')} |")


def block(document):
    """The table for README.md."""
    rows = ["| benchmark | quantity | Talus | analytic | published |", "|---|---|---|---|---|"]
    rows += [row(document, *chosen) for chosen in README_ROWS]
    shown = {case for case, _, _ in README_ROWS}
    commits = ", ".join(dict.fromkeys(info["program"]["commit"] for info in document["cases"] if info["case"] in shown))
    judged, passed = counts(document["results"])
    note = [f"Measured at commit {commits}, with the default kernel and transfer unless a row names another.",
            f"{len(document['cases'])} benchmarks judge {judged} numbers, of which {passed} pass.",
            "[Verification](docs/development/verification.md) lists all of them, also those that fail."]
    return "\n".join([*rows, "", *note, "", *first_price([info["case"] for info in document["cases"]])]).rstrip()


def replace_block(text, content):
    """`text` with a new content between the markers, or None unless each marker occurs once, in order."""
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        return None
    return f"{text.split(BEGIN)[0]}{BEGIN}\n{content}\n{END}{text.split(END)[1]}"


def merge(old, new):
    """The old document with cases replaced by those of the new one; additional cases come at the end."""
    fresh = {info["case"]: info for info in new["cases"]}
    known = {info["case"] for info in old["cases"]}
    cases = [fresh.get(info["case"], info) for info in old["cases"]] + [info for case, info in fresh.items() if case not in known]
    parts = {part: [e for info in cases for e in of(new if info["case"] in fresh else old, part, info["case"])] for part in ("results", "convergence", "figures")}
    return {"cases": cases, **parts}


def write(new, images):
    """Writes all three files and copies the figures; refuses runs with another kernel or transfer."""
    if any(info["overrides"] for info in new["cases"]):
        raise ValueError("the documents are written from runs without --kernel and --transfer")
    old = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {"cases": []}
    document = merge(old, new) if isinstance(old, dict) else new
    RESULTS.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    for figure in new["figures"]:
        if figure["shown"] == "everywhere":
            shutil.copyfile(images / figure["file"], ROOT / "docs/images" / figure["file"])
    write_documents(document)


def write_documents(document):
    """Writes docs/development/verification.md and the block in README.md."""
    (ROOT / "docs/development/verification.md").write_text(page(document), encoding="utf-8")
    readme = ROOT / "README.md"
    text = replace_block(readme.read_text(encoding="utf-8"), block(document))
    if text is None:
        raise ValueError(f"{readme}: the markers {BEGIN} and {END} are not there once and in order")
    readme.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    write(json.loads(source.read_text(encoding="utf-8")), source.parent / "report/images")
