#!/usr/bin/python3
"""Tests of the parts of the verification (benchmarks/*.py) that decide what is a pass and what is written where; nothing is simulated."""
import argparse
import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "benchmarks"))

import lab  # noqa: E402
import numpy as np  # noqa: E402
import pages  # noqa: E402
import regression  # noqa: E402
import report  # noqa: E402
import tradeoff  # noqa: E402
import verify  # noqa: E402

SUMMARY = {"kernel": "umls", "transfer": "flip, musl", "mesh": {"cells": 4}, "bodies": [{"particles": 6}],
           "cost": {"threads": 1, "peak_memory [B]": 1000}, "program": {"version": "1", "commit": "abc", "compiler": "gcc"}}


def result(value, criterion, tolerance=None, reference=None):
    return lab.Result("case", "metric", "m", value, criterion, tolerance, reference, "source", None)


class Verdicts(unittest.TestCase):
    def test_each_criterion_accepts_its_bound_and_refuses_more(self):
        for criterion, tolerance, reference, good, bad in [("at most", 1, None, 1, 1.01), ("at least", 1, None, 1, 0.99), ("within", 0.25, -4, -5, -5.01),
                                                           ("near", 1, -4, -5, -5.01)]:
            self.assertIs(result(good, criterion, tolerance, reference).passed, True, criterion)
            self.assertIs(result(bad, criterion, tolerance, reference).passed, False, criterion)

    def test_a_number_that_is_not_finite_never_passes(self):
        self.assertIs(result(float("nan"), "at most", 1).passed, False)
        self.assertIs(result(float("inf"), "at least", 1).passed, False)

    def test_what_is_only_reported_has_no_verdict(self):
        self.assertIsNone(result(1, "reported").passed)


def program(folder):
    """A stand-in for talus: fails where a setting says `fail`, else leaves a summary and a history with its words."""
    path = pathlib.Path(folder) / "program"
    path.write_text(f"""#!/bin/sh
case "$*" in *fail=1*) echo "error: $2: points went out" >&2; exit 3;; esac
mkdir -p "$4" && echo '{json.dumps(SUMMARY)}' > "$4/summary.json" && echo "$@" > "$4/words" && printf 'time [s],x\\n0,1\\n' > "$4/history.csv"
""", encoding="utf-8")
    path.chmod(0o755)
    return path


class Runs(unittest.TestCase):
    SCENE = "sliding_block/scene.yaml"

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = pathlib.Path(holder.name)

    def lab(self, **options):
        made = lab.Lab(program(self.folder), self.folder / "runs", self.folder / "images", **options)
        self.addCleanup(made.close)
        return made

    def test_runs_side_by_side_keep_their_results_apart(self):
        own = self.lab(jobs=3)
        runs = [own.run(self.SCENE, f"n{i}", {"a": i}) for i in range(6)]
        for i, run in enumerate(runs):
            self.assertIn(f"--set a={i}", (run.folder / "words").read_text(encoding="utf-8"))
            self.assertEqual((run.particles, run.cells, run.memory), (6, 4, 1000))
        self.assertEqual(own.runs_of("sliding_block"), runs)

    def test_a_run_that_fails_says_so_when_it_is_asked_and_stops_no_other(self):
        own = self.lab()
        bad, good = own.run(self.SCENE, "bad", {"fail": 1}), own.run(self.SCENE, "good", {})
        self.assertEqual(good.history["x"].tolist(), [1])
        with self.assertRaisesRegex(lab.RunFailed, "sliding_block/bad ended with 3: error: benchmarks/sliding_block/scene.yaml: points went out"):
            bad.history
        self.assertIn("points went out", bad.failure())
        self.assertIsNone(good.failure())

    def test_a_run_that_may_fail_has_an_ending_like_any_other_and_names_no_folder_of_a_machine(self):
        own = self.lab()
        bad, good = own.run(self.SCENE, "bad", {"fail": 1}, may_fail=True), own.run(self.SCENE, "good", {}, may_fail=True)
        self.assertEqual(bad.ending, (3, "error: benchmarks/sliding_block/scene.yaml: points went out"))
        self.assertIsNone(bad.failure())
        self.assertEqual(good.ending, (0, ""))

    def test_one_label_means_one_run(self):
        own = self.lab()
        self.assertIs(own.run(self.SCENE, "n", {"a": 1}), own.run(self.SCENE, "n", {"a": 1}))
        with self.assertRaises(ValueError):
            own.run(self.SCENE, "n", {"a": 2})

    def test_a_known_run_is_used_again_only_for_the_same_inputs(self):
        self.lab().run(self.SCENE, "n", {"a": 1}).folder.joinpath("words").write_text("old", encoding="utf-8")
        self.assertEqual((self.lab(reuse=True).run(self.SCENE, "n", {"a": 1}).folder / "words").read_text(encoding="utf-8"), "old")
        self.assertIn("a=2", (self.lab(reuse=True).run(self.SCENE, "n", {"a": 2}).folder / "words").read_text(encoding="utf-8"))

    def test_overrides_reach_the_runs_that_leave_the_choice_open(self):
        own = self.lab(overrides={"kernel": "linear", "transfer.scheme": "apic"})
        words = (own.run(self.SCENE, "open", {}).folder / "words").read_text(encoding="utf-8")
        self.assertIn("--set kernel=linear", words)
        self.assertIn("--set transfer.scheme=apic", words)
        words = (own.run(self.SCENE, "chosen", {"kernel": "umls", "transfer.scheme": "flip"}).folder / "words").read_text(encoding="utf-8")
        self.assertNotIn("linear", words)
        self.assertNotIn("apic", words)

    def test_other_kernels_have_runs_of_their_own_at_the_full_level_and_reported_results_that_name_them(self):
        def start(other):
            run = other.run(self.SCENE, "n", {"a": 1})
            return [(run, lambda: [lab.Result("sliding_block", "way", "m", 1.0, "within", 0.1, 2.0, "source", run)])]

        self.assertEqual(lab.with_other_kernels(self.lab(), start), [])
        results = lab.with_other_kernels(self.lab(level="full"), start)
        self.assertEqual([(r.metric, r.criterion, r.passed) for r in results], [("way, umls", "reported", None), ("way, linear", "reported", None)])
        words = (results[1].run.folder / "words").read_text(encoding="utf-8")
        self.assertIn("--set kernel=linear --set transfer.scheme=flip", words)

    def measured(self, evaluate):
        """Records and account of a case whose evaluate() is given."""
        known, lab.module = lab.module, lambda case: type("Case", (), {"evaluate": staticmethod(evaluate)})
        try:
            return verify.measure(self.lab(), "sliding_block", {})
        finally:
            lab.module = known

    def test_a_case_with_a_run_that_fails_has_a_failed_result_with_the_words_of_the_program(self):
        records, info = self.measured(lambda own: [own.run(self.SCENE, "bad", {"fail": 1}).history])
        self.assertEqual([(r["metric"], r["pass"]) for r in records], [("run bad", False)])
        self.assertIn("points went out", report.line(records[0]))
        self.assertEqual(info["runs"], 1)
        self.assertEqual(info["gone"], [])

    def test_an_error_in_a_case_is_a_failed_result(self):
        records, _ = self.measured(lambda own: [1 / 0])
        self.assertIn("ZeroDivisionError", records[0]["error"])
        self.assertIs(records[0]["pass"], False)

    def test_cases_that_nothing_passed_in_are_left_out_where_only_losses_matter(self):
        judged = verify.judged()
        self.assertIn("vibrating_bar", judged)
        self.assertNotIn("cook_membrane", judged, "it only reports")

    def test_cases_that_are_named_are_left_out(self):
        given = argparse.Namespace(cases=[], judged=False, but=["shock", "patch_test"])
        self.assertEqual(set(verify.CASES) - set(verify.chosen(given)), {"shock", "patch_test"})
        self.assertNotIn("cook_membrane", verify.chosen(argparse.Namespace(**{**vars(given), "judged": True})))

    def test_two_results_of_one_name_are_an_error(self):
        def evaluate(own):
            run = own.run(self.SCENE, "n", {})
            return [lab.Result("sliding_block", "twice", "m", float(value), "reported", None, None, "", run) for value in (1, 2)]
        records, _ = self.measured(evaluate)
        self.assertIn("two results are called twice", records[0]["error"])


class Regression(unittest.TestCase):
    def test_the_eighth_digit_counts_and_the_tenth_does_not(self):
        self.assertFalse(regression.differs(1.2345678, 1.2345678 * (1 + 1e-10)))
        self.assertTrue(regression.differs(1.2345680, 1.2345678))
        self.assertTrue(regression.differs(-4.0, 4.0))
        self.assertFalse(regression.differs(1.2385678, 1.2345678, 2))
        self.assertTrue(regression.differs(1.35, 1.2345678, 2))
        self.assertTrue(regression.differs(None, 4.0))

    def test_rounding_of_ratios_is_no_change(self):
        self.assertFalse(regression.differs(3e-14, 2e-15))
        self.assertTrue(regression.differs(3e-9, 0.0))

    def test_changes_are_named_and_what_is_new_or_gone_is_not_a_change(self):
        records = [{"metric": "a", "value": 1.1}, {"metric": "b", "value": 1.0}, {"metric": "new", "value": 3.0}]
        gone = regression.compare(records, {"a": 1.0, "b": 1.0, "old": 2.0}, ["b"])
        self.assertEqual(gone, ["old"])
        self.assertEqual([r["changed"] for r in records], ["changed by +10 %, was 1, is 1.1", None, None])
        self.assertEqual([r["known"] for r in records], [False, True, False])

    def test_known_shortfalls_end_with_zero_only_where_the_release_is_the_measure(self):
        info = {"processor_seconds": 1.0}
        for known, asked, status in ((True, True, 0), (False, True, 1), (True, False, 1)):
            record = {"case": "c", "metric": "m", "pass": False, "changed": None, "known": known}
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(verify.conclude({"results": [record], "cases": [info]}, argparse.Namespace(regression=asked, out="out"), 1.0), status)

    def test_what_got_worse_and_what_changed_is_named(self):
        records = [{"case": "c", "metric": "new shortfall", "pass": False, "changed": None, "known": False},
                   {"case": "c", "metric": "old shortfall", "pass": False, "changed": None, "known": True},
                   {"case": "c", "metric": "moved", "pass": True, "changed": "changed by +10 %, was 1, is 1.1", "known": False}]
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            status = verify.conclude({"results": records, "cases": []}, argparse.Namespace(regression=True, out="out"), 1.0)
        self.assertEqual(status, 1)
        self.assertIn("worse than the release: c, new shortfall\n", said.getvalue())
        self.assertIn("changed since the release: c, moved: changed by +10 %, was 1, is 1.1\n", said.getvalue())
        self.assertNotIn("old shortfall", said.getvalue())

    def test_what_is_stored_is_compared_and_failures_are_known(self):
        with tempfile.TemporaryDirectory() as folder:
            known, regression.ROOT = regression.ROOT, pathlib.Path(folder)
            try:
                (pathlib.Path(folder) / "benchmarks/c").mkdir(parents=True)
                self.assertEqual(regression.stored("c"), ({}, []))
                regression.write({"cases": [{"case": "c", "level": "quick", "program": {"version": "1", "commit": "abc"}}],
                                  "results": [{"case": "c", "metric": "m", "value": 1 / 3, "pass": False},
                                              {"case": "c", "metric": "run r", "value": None, "pass": False, "error": "did not come to rest"}]})
                values, failed = regression.stored("c")
            finally:
                regression.ROOT = known
        self.assertFalse(regression.differs(1 / 3, values["m"]))
        self.assertEqual(failed, ["m", "run r"])


class Tradeoff(unittest.TestCase):
    AXES = {"mesh": {"coarse": {}, "fine": {}}, "kernel": {"umls": {}, "linear": {}}, "cfl": {"0.4": {}, "0.2": {}, "0.1": {}}}

    def test_quick_changes_one_choice_at_a_time_on_every_mesh(self):
        chosen = tradeoff.combinations(self.AXES, False)
        self.assertEqual(len(chosen), 2 * (1 + 1 + 2))
        self.assertNotIn({"mesh": "fine", "kernel": "linear", "cfl": "0.2"}, chosen)
        self.assertEqual(len(tradeoff.combinations(self.AXES, True)), 12)

    def test_the_front_holds_what_nothing_beats(self):
        self.assertEqual(tradeoff.front([(3, 1), (1, 5), (2, 5), (2, 3), (4, 1), (5, 2), (1, 6)]), [1, 3, 0])

    def test_advice_names_the_cheapest_and_where_it_ends(self):
        points = [{"name": name, "error": error, "processor_seconds": seconds, "peak_memory [B]": 5e7}
                  for name, error, seconds in (("a", 0.05, 1.0), ("b", 0.02, 9.0), ("c", 0.009, 4.0))]
        self.assertEqual(tradeoff.advice(points), ["Cheapest for 10 % error: a (1 s, 50 MB, error 5 %).",
                                                   "Cheapest for 3 or 1 % error: c (4 s, 50 MB, error 0.9 %).",
                                                   "An error of 0.3 or 0.1 % is not reached; the smallest is 0.9 % with c (4 s, 50 MB)."])


class Documents(unittest.TestCase):
    def document(self, cases, value):
        info = [{"case": case, "title": case, "level": "quick", "overrides": {}, "program": SUMMARY["program"], "runs": 1, "processor_seconds": 1.0, "gone": []}
                for case in cases]
        records = [{**verify.failed(case, "m", "words"), "value": value, "pass": value > 0, "criterion": "at least", "tolerance": 0, "changed": None,
                    "release": None} for case in cases]
        for record in records:
            del record["error"]
        orders = [{"case": case, "name": "error", "sizes": [1, 0.5, 0.25], "errors": [4, 2, 0.5], "orders": [1.0, 2.0], "order": 1.5, "expected": 2} for case in cases]
        return {"cases": info, "results": records, "convergence": orders, "figures": []}

    def test_merging_replaces_the_cases_that_were_run_in_their_place(self):
        merged = report.merge(self.document(["a", "b"], 1), self.document(["b", "c"], 2))
        self.assertEqual([(r["case"], r["value"]) for r in merged["results"]], [("a", 1), ("b", 2), ("c", 2)])
        self.assertEqual([info["case"] for info in merged["cases"]], ["a", "b", "c"])

    def test_pages_show_verdict_and_orders(self):
        with tempfile.TemporaryDirectory() as folder:
            pages.write(self.document(["a"], 1), pathlib.Path(folder))
            page = (pathlib.Path(folder) / "a.html").read_text(encoding="utf-8")
            index = (pathlib.Path(folder) / "index.html").read_text(encoding="utf-8")
        self.assertIn('<span class="pass">pass</span>', page)
        self.assertIn("<td>0.5</td>\n<td>2</td>\n<td>1</td>", page)
        self.assertIn('<a href="a.html">a</a>', index)

    def test_documents_are_not_written_from_runs_with_another_kernel(self):
        document = self.document(["a"], 1)
        document["cases"][0]["overrides"] = {"kernel": "linear"}
        with self.assertRaises(ValueError):
            report.write(document, pathlib.Path("images"))

    def test_the_readme_has_at_most_twelve_rows_and_all_of_them_are_measured(self):
        self.assertLessEqual(len(report.README_ROWS), 12)
        table = report.block(json.loads(report.RESULTS.read_text(encoding="utf-8")))
        self.assertEqual(table.count("\n| ["), len(report.README_ROWS))

    def test_a_row_of_the_readme_that_is_not_measured_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "README_ROWS"):
            report.row(self.document(["a"], 1), "a", "another metric", "analytic")


class Measures(unittest.TestCase):
    def test_orders_between_neighbours(self):
        np.testing.assert_allclose(lab.neighbours([1, 0.5, 0.25], [4, 2, 0.5]), [1, 2], rtol=1e-12)

    def test_the_order_of_a_parabola_is_two(self):
        self.assertAlmostEqual(lab.observed_order([1, 0.5, 0.25], [3, 0.75, 0.1875]), 2, places=12)

    def test_an_empty_entry_is_finite_only_where_it_is_the_centre_of_nothing(self):
        finite, nan = lab.module("extremes").finite, float("nan")
        for mass, centre, kinetic, expected in ((1, 2, 3, True), (0, nan, 0, True), (1, nan, 3, False), (0, nan, nan, False), (nan, nan, 0, False),
                                                (1, float("inf"), 3, False)):
            history = {"mass": np.array([1, mass]), "centre_x": np.array([2, centre]), "kinetic": np.array([3, kinetic])}
            self.assertIs(bool(finite(history)), expected, (mass, centre, kinetic))


class ClosedForms(unittest.TestCase):
    """Of the dam break on a plane, which judge the chute: wrong ones would judge wrongly without a word."""

    chute = lab.module("granular_chute")
    data = lab.reference("granular_chute")

    def test_what_leaves_the_slab_is_in_the_fan(self):
        flow, time = self.chute.DamBreak(self.data, 0.4), 1.3
        back, front = flow.ends(time)
        x = np.linspace(back, front, 20001)
        self.assertAlmostEqual(np.trapz(flow.at(x, time), x), flow.depth * (flow.slide * time**2 / 2 - back), places=6)
        self.assertAlmostEqual(float(flow.at(flow.place(0.1, time), time)), 0.1)
        self.assertEqual(list(flow.at(np.array([back - 1, front + 1]), time)), [flow.depth, 0])

    def test_on_a_level_base_without_friction_it_is_that_of_ritter(self):
        data = {**self.data, "dam": {**self.data["dam"], "angle [deg]": 0, "base friction angle [deg]": 0}}
        self.assertAlmostEqual(float(self.chute.DamBreak(data, 1.0).at(0.0, 0.7)), 4 / 9)

    def test_earth_pressure_is_that_of_rankine_on_a_smooth_base_and_one_value_where_base_and_grains_are_alike(self):
        active, passive = self.chute.earth_pressure(np.radians(30), 0)
        self.assertAlmostEqual(active, 1 / 3)
        self.assertAlmostEqual(passive, 3)
        self.assertAlmostEqual(*self.chute.earth_pressure(np.radians(25), np.radians(25)), places=6)


class Readme(unittest.TestCase):
    def test_only_what_is_between_the_markers_is_replaced(self):
        text = f"before\n{report.BEGIN}\nold\n{report.END}\nafter\n"
        self.assertEqual(report.replace_block(text, "new"), f"before\n{report.BEGIN}\nnew\n{report.END}\nafter\n")

    def test_without_both_markers_in_order_nothing_is_replaced(self):
        for text in ("", report.BEGIN, f"{report.END}\n{report.BEGIN}", f"{report.BEGIN}{report.BEGIN}{report.END}"):
            self.assertIsNone(report.replace_block(text, "new"))


if __name__ == "__main__":
    unittest.main()
