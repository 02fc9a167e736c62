"""The report of a run of the suite as HTML: an index and a page per case. Plain pages, relative pictures, nothing from a network."""
import html
import re

import markdown
import numpy as np

import report
from lab import ROOT

STYLE = """body{font:16px/1.5 sans-serif;max-width:60em;margin:0 auto;padding:1em;color:#222}table{border-collapse:collapse;font-size:14px}
th,td{border:1px solid #ccc;padding:.2em .5em;text-align:left}th{background:#f3f3f3}img{max-width:100%;height:auto}.wide{overflow-x:auto}
.pass{color:#17692b}.FAIL{color:#b00020;font-weight:bold}.changed{color:#8a5a00}pre{white-space:pre-wrap;background:#f6f6f6;padding:.5em}
h2{margin-top:1.6em}figure{margin:1em 0}figcaption{color:#555;font-size:14px}"""
RELATIVE = re.compile(r'<a href="(?!https?:)[^"]*">(.*?)</a>', re.S)
HEADS = ["measured", "value", "unit", "reference", "criterion", "verdict", "last release", "cells", "particles", "kernel", "transfer", "s", "MB"]


def page(title, body):
    """A complete HTML page."""
    return (f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{html.escape(title)}</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n")


def cells(words, tag="td"):
    """One row of a table; entries that begin with '<' are HTML already."""
    return "<tr>" + "".join(f"<{tag}>{word if word.startswith('<') else html.escape(word)}</{tag}>" for word in words) + "</tr>"


def grid(heads, rows):
    """A table that scrolls on a narrow screen."""
    return f'<div class="wide"><table>\n{cells(heads, "th")}\n' + "\n".join(cells(row) for row in rows) + "\n</table></div>"


def verdict(passed):
    """pass, FAIL or a dash, coloured."""
    word = report.VERDICTS[passed].strip("*")
    return word if passed is None else f'<span class="{word}">{word}</span>'


def row(r):
    """A row for one number."""
    since = f'<span class="changed">{html.escape(r["changed"])}</span>' if r.get("changed") else "new" if r.get("release") is None else "same"
    memory = "-" if r["peak_memory [B]"] is None else f"{r['peak_memory [B]'] / 1e6:.0f}"
    return [r["metric"], report.number(r["value"]), r["unit"], report.number(r["reference"]), report.criterion(r), verdict(r["pass"]), since,
            (r["mesh"] or "-").split()[0], str(r["particles"] or "-"), r["kernel"] or "-", r["transfer"] or "-", report.number(r["processor_seconds"]), memory]


def problem(case):
    """The README.md of the case without its title; links to files of the repository become text."""
    path = ROOT / "benchmarks" / case / "README.md"
    if not path.exists():
        return "<p>(no description)</p>"
    text = path.read_text(encoding="utf-8").split("\n", 1)[-1]
    return RELATIVE.sub(r"\1", markdown.markdown(text, extensions=["tables", "fenced_code"]))


def outcome(records):
    """A sentence with the verdict of a case."""
    judged, passed = report.counts(records)
    changed = sum(bool(r.get("changed")) for r in records)
    return (f"{verdict(passed == judged if judged else None)} {passed} of {judged} judged numbers pass, {len(records) - judged} are reported only"
            f"{f', <span class=changed>{changed} changed since the last release</span>' if changed else ''}.")


def case_page(document, info):
    """The page of a case: problem, verdict, numbers, convergence, pictures."""
    case = info["case"]
    records, figures = report.of(document, "results", case), report.of(document, "figures", case)
    other = "".join(f", {key} {word} by option" for key, word in info["overrides"].items())
    parts = ['<p><a href="index.html">all cases</a></p>', f"<h1>{html.escape(info['title'])}</h1>", f"<p>{outcome(records)}</p>",
             f"<p>Program {html.escape(info['program']['version'])}, commit {html.escape(info['program']['commit'])}, {html.escape(info['program']['compiler'])}; level "
             f"{info['level']}{html.escape(other)}; {info['runs']} runs, {info['processor_seconds']:.1f} s of processor time.</p>"]
    parts += [f"<h2>{html.escape(r['metric'])}</h2><pre>{html.escape(r['error'])}</pre>" for r in records if "error" in r]
    parts += ["<h2>Problem</h2>", problem(case), "<h2>Numbers</h2>", grid(HEADS, [row(r) for r in records])]
    sources = dict.fromkeys(r["source"] for r in records if r["source"])
    parts += ["<h2>References</h2><ul>", *(f"<li>{html.escape(source)}</li>" for source in sources), "</ul>"]
    if info["gone"]:
        parts.append(f"<p class=changed>In the last release, not measured now: {html.escape('; '.join(info['gone']))}.</p>")
    orders = report.of(document, "convergence", case)
    parts += ["<h2>Convergence</h2>"] if orders else []
    parts += [markdown.markdown("\n".join(report.orders(entry)), extensions=["tables"]) for entry in orders]
    parts += ["<h2>Pictures</h2>"] if figures else []
    parts += [f'<figure><img src="images/{f["file"]}" alt="{html.escape(f["caption"])}"><figcaption>{html.escape(f["caption"])}</figcaption></figure>'
              for f in figures]
    return page(info["title"], "\n".join(parts))


def index(document):
    """The page with the list of cases."""
    rows = []
    for info in document["cases"]:
        records = report.of(document, "results", info["case"])
        judged, passed = report.counts(records)
        rows.append([f'<a href="{info["case"]}.html">{html.escape(info["title"])}</a>', verdict(passed == judged if judged else None), f"{passed} of {judged}",
                     str(sum(bool(r.get("changed")) for r in records)), f"{info['processor_seconds']:.0f}"])
    judged, passed = report.counts(document["results"])
    body = (f"<h1>Verification of Talus</h1>\n<p>{passed} of {judged} judged numbers pass; {len(document['results']) - judged} are reported only.</p>\n"
            + grid(["case", "verdict", "passed", "changed since the release", "processor time [s]"], rows))
    return page("Verification of Talus", body)


def write(document, folder):
    """Writes all pages into a folder; pictures are expected in its folder images/."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "index.html").write_text(index(document), encoding="utf-8")
    for info in document["cases"]:
        (folder / f"{info['case']}.html").write_text(case_page(document, info), encoding="utf-8")


def draw_particles(figure, frame, dimension):
    """Draws the particles of a frame, viewed along the shortest side of the body, coloured by displacement or speed."""
    points = frame["position"]
    extent = np.ptp(points, axis=0)
    across = 2 if dimension == 2 else int(np.argmin(extent))
    a, b = [axis for axis in range(3) if axis != across]
    name = "displacement" if "displacement" in frame else "velocity" if "velocity" in frame else None
    colour = np.linalg.norm(frame[name], axis=1) if name else np.zeros(len(points))
    order = np.argsort(points[:, across], kind="stable") if dimension == 3 else slice(None)
    axis = figure.subplots()
    dots = axis.scatter(points[order, a], points[order, b], c=colour[order], s=max(0.5, min(30, 4e4 / len(points))), linewidths=0, cmap="viridis")
    axis.set(aspect="equal", xlabel=f"{'xyz'[a]} [m]", ylabel=f"{'xyz'[b]} [m]")
    if name:
        figure.colorbar(dots, label="displacement [m]" if name == "displacement" else "speed [m/s]", shrink=0.7)
