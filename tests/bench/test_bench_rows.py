#!/usr/bin/env python3
"""Tests of what ./dev bench makes of the rows of spidar_bench, and of the rows themselves on few problems.

test_bench_rows.py spidar_bench
"""

import csv
import os
import subprocess
import sys
import tempfile
import unittest

import bench_rows
import run_bench
import write_tables


def row(method="ours", of_set="S1", mode="cold", **figures):
    one = dict.fromkeys(bench_rows.FIGURES, 1.0)
    return {"method": method, "set": of_set, "mode": mode, **one, "failures": 0, **figures}


class Combine(unittest.TestCase):
    def test_times_are_medians_and_errors_the_worst(self):
        runs = [[row(median_ns=t, worst_error=e, failures=f)] for t, e, f in ((3, 2, 0), (9, 5, 4), (4, 1, 0))]
        combined = bench_rows.combine(runs)[0]
        self.assertEqual((combined["median_ns"], combined["worst_error"], combined["failures"]), (4, 5, 4))

    def test_a_figure_without_bound_in_one_run_has_none(self):
        self.assertIsNone(bench_rows.combine([[row()], [row(worst_error=None)]])[0]["worst_error"])

    def test_runs_of_different_builds_are_refused(self):
        with self.assertRaises(ValueError):
            bench_rows.combine([[row()], [row(method="other")]])

    def test_the_fastest_of_several_builds_is_found(self):
        rows = [row("DAQP, plain", median_ns=7.0), row("DAQP, avx2", median_ns=5.0), row("ours", median_ns=1.0)]
        self.assertEqual(bench_rows.find(rows, "DAQP", "S1", "cold")["method"], "DAQP, avx2")
        self.assertIsNone(bench_rows.find(rows, "DAQP", "S1", "warm"))

    def test_bars(self):
        runs = [{"fk": [], "step": [],
                 "tension": [row(ratio_to_daqp=ratio, p999_ns=3.0), row("DAQP", p999_ns=2.0, median_ns=4.0)]}
                for ratio in (0.2, 0.4, 0.25)]
        verdicts = {text: (bar, figure) for text, bar, figure in bench_rows.judge(runs)}
        self.assertEqual(verdicts["tensions, S1 cold / DAQP"], (0.25, 0.25))
        self.assertIsNone(verdicts["tensions, S3 cold / DAQP"][1])
        text = run_bench.bars_as_markdown(bench_rows.judge(runs))
        self.assertIn("| tensions, S1 cold / DAQP | 0.25 | 0.250 | met |", text)
        self.assertIn("| tensions, S3 cold / DAQP | 0.145 | - | not measured |", text)
        self.assertIn("| the same, p99.9 / p99.9 | 1 | 1.500 | missed |", text)


class Rows(unittest.TestCase):
    """The program on few problems, whatever peers are there."""

    def test_each_problem(self):
        for problem in bench_rows.PROBLEMS + bench_rows.APART:
            with self.subTest(problem), tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "rows.json")
                done = subprocess.run([PROGRAM, problem, "--rows", "400", "--json", path], capture_output=True,
                                      text=True)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                rows = bench_rows.read_rows(path)
                self.assertEqual(len({bench_rows.key(one) for one in rows}), len(rows), "two rows of one name")
                for one in rows:
                    self.assertEqual(tuple(one), bench_rows.COLUMNS)
                    self.assertLessEqual(one["median_ns"], one["p99_ns"])
                    self.assertLessEqual(one["p99_ns"], one["p999_ns"])
                    self.assertLessEqual(one["p999_ns"], one["max_ns"])
                copy = os.path.join(folder, "copy")
                bench_rows.write_rows(rows, copy + ".json", copy + ".csv")
                self.assertEqual(bench_rows.read_rows(copy + ".json"), rows)
                with open(copy + ".csv", encoding="utf-8") as file:
                    table = list(csv.DictReader(file))
                self.assertEqual([one["method"] for one in table], [one["method"] for one in rows])

    def test_every_bar_has_its_row(self):
        runs = {}
        for problem in bench_rows.PROBLEMS:
            with tempfile.NamedTemporaryFile(suffix=".json") as file:
                subprocess.run([PROGRAM, problem, "--rows", "200", "--json", file.name], capture_output=True)
                runs[problem] = bench_rows.read_rows(file.name)
        # A ratio to a peer that is not here is none; what is ours must be there under the name that the bar uses.
        for problem, method, of_set, mode in (
                ("fk", "ours", "T1 counts", "warm"), ("fk", "ours", "T1 counts", "cold"),
                ("fk", "dense damped Gauss-Newton", "T1 counts", "2 steps"), ("tension", "ours", "S2 shipped", "warm"),
                ("tension", "ours", "S3", "cold"), ("step", "step, wrench and 4 contacts", "step", "moving"),
                ("step", "step, nothing asked", "step", "at rest"), ("step", "cycle", "recording", "on")):
            self.assertIsNotNone(bench_rows.find(runs[problem], method, of_set, mode), (problem, method, of_set, mode))


class Results(unittest.TestCase):
    def test_committed_results_are_of_this_form(self):
        folder = os.path.join(run_bench.ROOT, "tests", "bench", "results")
        for problem in bench_rows.PROBLEMS + bench_rows.APART:
            rows = bench_rows.read_rows(os.path.join(folder, problem + ".json"))
            self.assertTrue(rows)
            self.assertTrue(all(tuple(one) == bench_rows.COLUMNS for one in rows))

    def test_the_page_tells_the_committed_results(self):
        path = os.path.join(run_bench.ROOT, "docs", "why", "accuracy_and_speed.md")
        with open(path, encoding="utf-8") as file:
            page = file.read()
        self.assertEqual(len(write_tables.MARK.findall(page)), 5)
        folder = os.path.join(run_bench.ROOT, "tests", "bench", "results")
        self.assertEqual(write_tables.fill(page, folder), page,
                         "run python3 tests/bench/write_tables.py tests/bench/results docs/why/accuracy_and_speed.md")


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    os.chdir(run_bench.ROOT)
    outcome = unittest.main(exit=False).result
    wrong = len(outcome.failures) + len(outcome.errors)
    print(f"{outcome.testsRun - wrong} passed, {wrong} failed")
    sys.exit(1 if wrong else 0)
