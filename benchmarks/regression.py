"""Each benchmark stores, beside its reference, the values of the last release (quick level) in release.json; what differs is named.

A change is no failure by itself: a better method changes numbers. It must be seen, and meant. What failed in the release is a known shortfall.
"""
import json
import math

from lab import ROOT

DIGITS = 8
NOTHING = 1e-12  # a ratio smaller than this is rounding: drifts of momentum, changes of mass


def path(case):
    """The file with the values of a case."""
    return ROOT / "benchmarks" / case / "release.json"


def stored(case):
    """{metric: value} of the last release, and the metrics that failed in it; empty without a release."""
    known = json.loads(path(case).read_text(encoding="utf-8")) if path(case).exists() else {"values": {}, "failed": []}
    return known["values"], known["failed"]


def differs(value, old, digits=DIGITS):
    """Whether the last of so many digits of the old value changed, by more than one unit. A run gives the same bits again on one machine with one compiler; another
    processor or compiler rounds otherwise, which smooth problems show in the tenth digit or later, and failing soil, contact and shocks earlier."""
    if value is None or old is None:
        return value is not old
    if max(abs(value), abs(old)) < NOTHING:
        return False
    unit = 10.0 ** (math.floor(math.log10(abs(old))) - digits + 1) if old else NOTHING
    return abs(value - old) > 1.001 * unit


def change(value, old):
    """A change as text."""
    if value is None or old is None or not old:
        return f"changed from {old} to {value}"
    return f"changed by {(value - old) / abs(old) * 100:+.2g} %, was {old:.{DIGITS}g}, is {value:.{DIGITS}g}"


def compare(records, values, failed, digits=DIGITS):
    """Adds 'release', 'changed' (words, or None) and 'known' (it failed in the release) to the records of a case; returns the metrics that are
    measured no more."""
    for record in records:
        record["known"] = record["metric"] in failed
        record["release"] = values.get(record["metric"])
        known = record["metric"] in values
        record["changed"] = change(record["value"], record["release"]) if known and differs(record["value"], record["release"], digits) else None
    return sorted(values.keys() - {record["metric"] for record in records})


def write(document):
    """Stores the values of all cases that have any; a failed run is a known shortfall, like a failed number."""
    measured = {record["case"] for record in document["results"] if "error" not in record}
    for case in document["cases"]:
        if case["case"] not in measured:
            continue
        values = {r["metric"]: None if r["value"] is None else float(f"{r['value']:.{DIGITS + 4}g}") for r in document["results"] if r["case"] == case["case"]}
        text = json.dumps({"program": case["program"]["version"], "commit": case["program"]["commit"], "level": case["level"],
                           "values": values, "failed": [r["metric"] for r in document["results"] if r["case"] == case["case"] and r["pass"] is False]}, indent=1)
        path(case["case"]).write_text(text + "\n", encoding="utf-8")
