#!/usr/bin/python3
"""Runs the benchmarks with a built talus against their references; writes OUT/verify.json and OUT/report/index.html.

Usage: talus verify [case ...] [--level quick|full] [--kernel K] [--transfer T] [--out DIR]      without cases: all of them
Exit status: 0 all judged numbers pass, 1 some do not or a run failed, 2 wrong words, 3 a module of Python is missing.
"""
import argparse
import concurrent.futures
import importlib.util
import json
import os
import pathlib
import sys
import time
import traceback

MODULES = {"numpy": "python3-numpy", "matplotlib": "python3-matplotlib", "lz4": "python3-lz4", "markdown": "python3-markdown"}
if missing := [package for module, package in MODULES.items() if importlib.util.find_spec(module) is None]:
    print(f"error: {sys.executable} has not all modules: install {' '.join(missing)} (Debian: apt-get install {' '.join(missing)})", file=sys.stderr)
    sys.exit(3)

import lab as tools  # noqa: E402
import pages  # noqa: E402
import regression  # noqa: E402
import report  # noqa: E402

CASES = [
    "single_particle_bar",
    "vibrating_bar",
    "viscoelastic_bar",
    "irregular_bar",
    "self_weight_column",
    "manufactured_solution",
    "generalized_vortex",
    "patch_test",
    "loaded_surface",
    "rigid_bodies",
    "floating_block",
    "rigid_motion",
    "sliding_block",
    "wall_gap",
    "sheet",
    "wedge",
    "colliding_disks",
    "contact",
    "contact_bodies",
    "cut",
    "cantilever",
    "slope_failure_2d",
    "slope_failure_3d",
    "shock",
    "taylor_bar",
    "cook_membrane",
    "plate_with_hole",
    "elastica",
    "equilibrium",
    "pulled_bar",
    "hertz_contact",
    "sphere_container",
    "infinite_slope",
    "fluid_layer",
    "arrest",
    "dam_break",
    "granular_layer",
    "granular_chute",
    "clay_block",
    "snow_block",
    "softening_band",
    "consolidation",
    "saturated_soil",
    "seepage",
    "strip_footing",
    "factor_of_safety",
    "random_slope",
    "column_collapse",
    "cohesive_collapse",
    "accuracy",
    "extremes",
]
SUITE = pathlib.Path(__file__).resolve().parent


def parser(text):
    """Options that `talus verify` and `talus tradeoff` have in common."""
    options = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--out", type=pathlib.Path, help="folder for runs and report; default runs/verify or runs/tradeoff")
    options.add_argument("--runs", type=pathlib.Path, help="folder for the runs alone; default OUT/runs")
    options.add_argument("--level", choices=["quick", "full"], default="quick")
    options.add_argument("--jobs", type=int, help="runs at a time; default as many as there are cores for the threads of each")
    options.add_argument("--threads", type=int, default=1, help="threads of each run")
    options.add_argument("--reuse", action="store_true", help="do not repeat runs whose program and inputs are unchanged")
    options.add_argument("--program", type=pathlib.Path, default=SUITE.parent / "build/talus", help="default build/talus")
    options.add_argument("--write-docs", action="store_true", help="for developers: also write the documents of the repository from the results")
    return options


def settle(options, given, name):
    """Sets defaults of the options: folders, number of jobs; ends with a message for invalid options."""
    if not given.program.exists():
        options.error(f"{given.program} is not there: make build")
    given.out = given.out or given.runs or pathlib.Path("runs") / name
    given.runs = given.runs or given.out / "runs"
    given.jobs = given.jobs or max(1, len(os.sched_getaffinity(0)) // given.threads)
    if given.jobs < 1 or given.threads < 1:
        options.error("--jobs and --threads are at least 1")
    return given


def arguments():
    options = parser(__doc__)
    options.add_argument("cases", nargs="*", metavar="case", help=", ".join(CASES))
    options.add_argument("--kernel", help="kernel of every run that does not choose one itself")
    options.add_argument("--transfer", help="transfer scheme of every run that does not choose one itself")
    options.add_argument("--release", action="store_true", help="for developers: store the values as those of the release (release.json of each case)")
    options.add_argument("--regression", action="store_true", help="status 1 only where something is worse than in the last release: a run failed, or a number that passed then or is new")
    options.add_argument("--judged", action="store_true", help="for developers: leave out cases of which nothing passed in the release, so that nothing can become worse")
    options.add_argument("--but", nargs="+", metavar="case", default=[], help="for developers: leave out these cases")
    options.add_argument("--digits", type=int, default=regression.DIGITS, help="for developers: a number has changed since the release where one of so many digits has")
    given = options.parse_args()
    if unknown := [case for case in given.cases + given.but if case not in CASES]:
        options.error(f"no case {', '.join(unknown)}; there are: {', '.join(CASES)}")
    if given.release and (given.kernel or given.transfer or given.level != "quick"):
        options.error("--release stores values of the quick level without --kernel and --transfer")
    if given.write_docs and (given.kernel or given.transfer):
        options.error("--write-docs wants runs without --kernel and --transfer")
    return settle(options, given, "verify")


def judged():
    """The cases with at least one number that passed in the release."""
    results = json.loads((SUITE / "results.json").read_text(encoding="utf-8"))["results"]
    return [case for case in CASES if any(record["case"] == case and record["pass"] for record in results)]


def chosen(given):
    """The cases selected on the command line."""
    cases = given.cases or (judged() if given.judged else CASES)
    return [case for case in cases if case not in given.but]


def failed(case, metric, words):
    """The record of a failed run or evaluation."""
    blank = dict.fromkeys(["value", "reference", "tolerance", "mesh", "particles", "kernel", "transfer", "processor_seconds", "peak_memory [B]", "threads", "commit"])
    return {"case": case, "metric": metric, "unit": "-", **blank, "source": "", "criterion": "runs", "pass": False, "error": words}


def measure(lab, case, overrides, digits=regression.DIGITS):
    """All results of one case as records, and its summary for the reports; failed runs and errors in case.py are failed results."""
    try:
        records = [result.record() for result in tools.module(case).evaluate(lab)]
        names = [record["metric"] for record in records]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise ValueError(f"two results are called {'; '.join(twice)}")
        picture(lab, case)
    except tools.RunFailed:
        records = []
    except Exception as error:  # the other cases continue
        records = [failed(case, "evaluation", f"{type(error).__name__}: {error}\n{traceback.format_exc()}")]
    runs = lab.runs_of(case)
    broken = [failed(case, f"run {run.label}", words) for run in runs if (words := run.failure())]
    ended = [run for run in runs if not run.failure()]
    records += broken
    program = ended[0].summary["program"] if ended else dict.fromkeys(["version", "commit", "compiler"], "unknown")
    compared = lab.level == "quick" and not overrides
    gone = regression.compare(records, *(regression.stored(case) if compared else ({}, [])), digits)
    return records, {"case": case, "title": title(case), "level": lab.level, "overrides": overrides, "program": program, "runs": len(runs),
                     "processor_seconds": sum(run.seconds for run in ended), "gone": gone if compared and not any("error" in r for r in records) else []}


def title(case):
    """The title in the README.md of the case."""
    path = SUITE / case / "README.md"
    return path.read_text(encoding="utf-8").splitlines()[0].lstrip("# ") if path.exists() else case


def picture(lab, case):
    """Draws the last frame of the run with the most particles, for the HTML report."""
    framed = [run for run in lab.runs_of(case) if not run.failure() and run.frames]
    if framed:
        run = max(framed, key=lambda run: run.particles)
        lab.figure(case, f"particles_{case}", lambda figure: pages.draw_particles(figure, run.last_frame(), run.summary["dimension"]),
                   caption=f"Particles at the end of {run.label}.", shown="report")


def conduct(lab, cases, overrides, digits):
    """Runs all cases in parallel; returns the contents of verify.json, in the order of the cases."""
    with concurrent.futures.ThreadPoolExecutor(max(1, len(cases))) as pool:
        try:
            pending = {pool.submit(measure, lab, case, overrides, digits): case for case in cases}
            for done in concurrent.futures.as_completed(pending):
                records, info = done.result()
                told = [f"{pending[done]}: {info['runs']} runs, {info['processor_seconds']:.1f} s of processor time", *("  " + report.line(r) for r in records),
                        *(f"      not measured any more: {metric}" for metric in info["gone"])]
                print("\n".join(told), flush=True)
        finally:
            lab.close()
    ended = [done.result() for done in pending]
    return {"cases": [info for _, info in ended], "results": [record for records, _ in ended for record in records],
            "convergence": in_order(lab.orders, cases), "figures": in_order(lab.figures, cases)}


def in_order(entries, cases):
    """Entries of the cases in the order of the cases."""
    return sorted(entries, key=lambda entry: cases.index(entry["case"]))


def main():
    given = arguments()
    overrides = {key: word for key in tools.OVERRIDES if (word := getattr(given, key))}
    lab = tools.Lab(given.program, given.runs, given.out / "report/images", given.level, given.reuse, given.threads, given.jobs,
                    {tools.OVERRIDES[key]: word for key, word in overrides.items()})
    start = time.monotonic()
    document = conduct(lab, chosen(given), overrides, given.digits)
    given.out.mkdir(parents=True, exist_ok=True)
    (given.out / "verify.json").write_text(json.dumps(document, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    pages.write(document, given.out / "report")
    if given.release:
        regression.write(document)
    if given.write_docs:
        report.write(document, given.out / "report/images")
    return conclude(document, given, time.monotonic() - start)


def conclude(document, given, seconds):
    """Prints the outcome; returns the exit status."""
    records = document["results"]
    judged, passed = report.counts(records)
    changed = [record for record in records if record["changed"]]
    for record in changed:
        print(f"changed since the release: {record['case']}, {record['metric']}: {record['changed']}")
    print(f"{len(records)} results, {passed} passed, {judged - passed} failed, {len(changed)} changed since the release; {seconds:.0f} s, "
          f"{sum(info['processor_seconds'] for info in document['cases']):.0f} s of processor time\n{given.out}/verify.json\n{given.out}/report/index.html")
    worse = [record for record in records if record["pass"] is False and not (given.regression and record["known"])]
    for record in worse if given.regression else []:
        print(f"worse than the release: {record['case']}, {record['metric']}")
    return 1 if worse else 0


def end(main):
    """Ends the process with the status of main(); 3 where a file cannot be written or read, 130 at Ctrl-C."""
    try:
        sys.exit(main())
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(3)
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    end(main)
