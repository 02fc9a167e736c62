#!/usr/bin/python3
"""Tests of talus.strength_reduction without the program: what motion says, and which factors come next.

Usage: fos_parts_test.py PROGRAM, which is not used.
"""
import csv
import math
import sys
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
from talus import RunFailed, Table  # noqa: E402
from talus.strength_reduction.search import (FAILS, HOLDS, UNCLEAR, AtRest, Criterion, Motion, Range, Trial, bracket_of,  # noqa: E402
                                             judge, motion_of, next_factors, usual_duration)
from scratch import InAFolder  # noqa: E402

BANK = AtRest(gravity=10, height=10, wave_speed=100)  # settles by 0.1 m under its own weight


def motion(growth, liveliness=None, steadiness=None):
    return Motion(moved=1, growth=growth, liveliness=liveliness, steadiness=steadiness, duration=4)


class Verdicts(InAFolder):
    def history(self, moved, kinetic):
        """A history of 4 s with displacements and kinetic energies by functions of time."""
        with open("history.csv", "w", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["time [s]", "mass [kg]", "kinetic [J]", "moved [m]"])
            writer.writerows([0.04 * row, 1000, kinetic(0.04 * row), moved(0.04 * row)] for row in range(101))
        return Table("history.csv")

    def test_motion_is_what_is_added_in_the_second_half_and_what_is_still_alive(self):
        slides = motion_of(self.history(lambda t: 0.5 * t, lambda t: 10 * t), ["moved"], BANK)
        self.assertAlmostEqual(slides.growth, 1, 12)
        self.assertAlmostEqual(slides.liveliness, 0.95, 12, "mean from 3.6 to 4 s over the peak at 4 s")
        self.assertAlmostEqual(slides.moved, 2, 12)
        self.assertAlmostEqual(slides.duration, 4, 12)
        self.assertEqual(judge(slides, Criterion()), FAILS)
        rests = motion_of(self.history(lambda t: min(t, 1), lambda t: 100 if t < 1 else 0), ["moved"], BANK)
        self.assertEqual((rests.growth, rests.liveliness), (0, 0))
        self.assertEqual(judge(rests, Criterion()), HOLDS)

    def test_what_is_small_beside_the_settlement_is_no_growth(self):
        trembles = motion_of(self.history(lambda t: 1e-5 * t, lambda t: 1e-6), ["moved"], BANK)
        self.assertAlmostEqual(trembles.growth, 2e-5 / 0.05, 12)
        self.assertAlmostEqual(trembles.liveliness, 1, 12)
        self.assertEqual(judge(trembles, Criterion()), HOLDS)

    def test_measures_that_contradict_each_other_are_unclear(self):
        self.assertEqual(judge(motion(0.2, 1e-5), Criterion()), UNCLEAR)
        self.assertEqual(judge(motion(0.05, 1e-2), Criterion()), UNCLEAR)
        self.assertEqual(judge(motion(0.019, 1e-2), Criterion()), HOLDS, "a fifth of the limit is clear")
        self.assertEqual(judge(motion(0.51, 1e-5), Criterion()), FAILS)
        self.assertEqual(judge(motion(math.nan, 1), Criterion()), FAILS)
        self.assertIsNone(motion_of(self.history(lambda t: t, lambda t: t), ["crest"], BANK))

    def test_a_slide_that_has_come_to_rest_has_failed(self):
        slid = motion_of(self.history(lambda t: min(2 * t, 1.5), lambda t: 100 if t < 1 else 0), ["moved"], BANK)
        self.assertEqual((slid.growth, slid.far), (0, True), "by more than a tenth of the height")
        self.assertEqual(judge(slid, Criterion()), FAILS)
        soft = AtRest(gravity=10, height=10, wave_speed=25)
        self.assertEqual(judge(motion_of(Table("history.csv"), ["moved"], soft), Criterion()), HOLDS, "it settles by 1.6 m")

    def test_ground_of_which_a_part_has_left_has_failed(self):
        self.history(lambda t: min(t, 1), lambda t: 100 if t < 1 else 0)
        text = Path("history.csv").read_text(encoding="utf-8").splitlines()
        left = [line.replace(",1000,", ",980,") if float(line.split(",")[0]) > 3 else line for line in text[1:]]
        Path("history.csv").write_text("\n".join([text[0], *left]) + "\n", encoding="utf-8")
        motion_with_loss = motion_of(Table("history.csv"), ["moved"], BANK)
        self.assertAlmostEqual(motion_with_loss.lost, 0.02, 12)
        self.assertEqual(judge(motion_with_loss, Criterion()), FAILS)
        self.assertEqual(judge(motion_with_loss, Criterion(lost=0.03)), HOLDS)

    def test_equilibria_fail_where_they_move_on_steadily(self):
        slides = motion_of(self.history(lambda t: 0.5 * t, lambda t: 0), ["moved"], BANK)
        self.assertIsNone(slides.liveliness)
        self.assertAlmostEqual(slides.steadiness, 1, 9)
        self.assertEqual(judge(slides, Criterion()), FAILS)
        settles = motion_of(self.history(lambda t: 1 - math.exp(-t / 1.5), lambda t: 0), ["moved"], BANK)
        self.assertGreater(settles.growth, 0.1)
        self.assertAlmostEqual(settles.steadiness, math.exp(-4 / 3 / 1.5), 3)
        self.assertEqual(judge(settles, Criterion()), HOLDS, "moves less and less")
        rests = motion_of(self.history(lambda t: 0, lambda t: 0), ["moved"], BANK)
        self.assertEqual(judge(rests, Criterion()), HOLDS)

    def test_duration_follows_from_height_and_waves(self):
        self.assertAlmostEqual(usual_duration(BANK), 3, 12)
        self.assertAlmostEqual(usual_duration(AtRest(10, 10, 30)), 6.7, 12, "twenty passes of waves")
        self.assertAlmostEqual(BANK.settlement, 0.1, 12)


def search(truth, asked, jobs):
    """Searches with a slope that fails above `truth`: the factors in the order in which they were tried, and the trials."""
    trials, rounds = [], []
    while factors := next_factors(trials, asked, jobs):
        rounds.append(factors)
        trials += [Trial(factor, FAILS if factor > truth else HOLDS) for factor in factors]
    return rounds, trials


class Factors(unittest.TestCase):
    def test_bisects_on_tidy_factors_until_the_bracket_is_narrow(self):
        rounds, trials = search(1.37, Range(1, 2, 0.1), 1)
        self.assertEqual(rounds, [[1], [2], [1.5], [1.25], [1.4], [1.3]])
        self.assertEqual((bracket_of(trials).low, bracket_of(trials).high), (1.3, 1.4))

    def test_tries_several_factors_at_the_same_time(self):
        rounds, trials = search(1.37, Range(0.5, 3, 0.02), 4)
        self.assertEqual(rounds[:2], [[0.5, 3], [1, 1.5, 2, 2.5]])
        self.assertLessEqual(len(rounds), 5)
        bracket = bracket_of(trials)
        self.assertTrue(bracket.is_narrow(0.02))
        self.assertTrue(bracket.low <= 1.37 < bracket.high)

    def test_finds_any_factor_with_any_number_of_jobs(self):
        for truth in np.random.default_rng(1).uniform(0.1, 20, 40):
            for jobs in (1, 2, 3, 7):
                _, trials = search(truth, Range(0.5, 3, 0.03), jobs)
                bracket = bracket_of(trials)
                self.assertTrue(bracket.low <= truth < bracket.high and bracket.is_narrow(0.03), (truth, jobs, bracket))
                self.assertEqual(len({trial.factor for trial in trials}), len(trials), "no factor is tried twice")

    def test_the_range_is_extended_and_then_refused(self):
        self.assertGreaterEqual(bracket_of(search(7, Range(1, 2, 0.5), 2)[1]).low, 6.5)
        self.assertLessEqual(bracket_of(search(0.3, Range(1, 2, 0.1), 2)[1]).high, 0.4)
        for truth in (1e3, 0):
            with self.assertRaises(RunFailed):
                search(truth, Range(1, 2, 0.1), 2)

    def test_verdicts_that_are_not_in_order_are_known(self):
        bracket = bracket_of([Trial(1, HOLDS), Trial(1.2, FAILS), Trial(1.3, HOLDS), Trial(1.4, FAILS)])
        self.assertEqual((bracket.low, bracket.high, bracket.out_of_order), (1, 1.2, [1.3]))


if __name__ == "__main__":
    sys.argv.pop(1)
    unittest.main()
