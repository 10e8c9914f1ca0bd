#!/usr/bin/env python3
"""run_bench.py OUT [--runs N] [--rows N]: runs build/bin/spidar_bench on each problem N times and leaves in OUT one
JSON and one CSV file a problem, machine.txt, and bars.md: what was asked for and what was measured.

Times and ratios are medians over the runs. Ends with 1 when a method of ours failed anywhere.
"""

import argparse
import os
import platform
import subprocess
import sys
import tempfile

import bench_rows

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.path.join("build", "bin", "spidar_bench")


def run_once(problem, rows, quiet):
    """(exit code, first line of the output, rows) of one run."""
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        command = [PROGRAM, problem, "--json", file.name]
        command += ["--rows", str(rows)] if rows else []
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        if not quiet:
            print(done.stdout.partition("\n")[2])
        return done.returncode, done.stdout.partition("\n")[0], bench_rows.read_rows(file.name)


def bars_as_markdown(verdicts):
    lines = ["| measured as a ratio | bar | measured | |", "|---|---|---|---|"]
    for text, bar, figure in verdicts:
        measured = "-" if figure is None else f"{figure:.3f}"
        verdict = "not measured" if figure is None else "met" if figure <= bar else "missed"
        lines.append(f"| {text} | {bar:g} | {measured} | {verdict} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out")
    parser.add_argument("--runs", type=int, default=1)
    parser.add_argument("--rows", type=int, default=0, help="problems of a set at most; 0: all")
    parser.add_argument("--problem", choices=bench_rows.APART, help="this one alone, without bars")
    options = parser.parse_args()
    if options.runs < 1 or options.rows < 0:
        parser.error(f"--runs is {options.runs}, --rows {options.rows}: give 1 or more, 0 or more")
    os.makedirs(options.out, exist_ok=True)
    problems = (options.problem,) if options.problem else bench_rows.PROBLEMS
    runs = [{} for _ in range(options.runs)]
    machines, code = [], 0
    for number, run in enumerate(runs):
        for problem in problems:
            print(f"bench: {problem}, run {number + 1} of {options.runs}", flush=True)
            failed, machine, run[problem] = run_once(problem, options.rows, quiet=number > 0)
            machines.append(machine)
            if failed:
                print(f"bench: {problem}: a row of ours failed, see above", file=sys.stderr)
                code = 1
    for problem in problems:
        path = os.path.join(options.out, problem)
        bench_rows.write_rows(bench_rows.combine([run[problem] for run in runs]), path + ".json", path + ".csv")
    if options.problem:
        return code
    bars = bars_as_markdown(bench_rows.judge(runs))
    with open(os.path.join(options.out, "bars.md"), "w", encoding="utf-8") as file:
        file.write(bars)
    with open(os.path.join(options.out, "machine.txt"), "w", encoding="utf-8") as file:
        file.write(f"{options.runs} runs, {options.rows or 'all'} rows; {platform.system()} {platform.release()}\n")
        file.writelines(machine + "\n" for machine in machines)
    print("\n" + bars)
    return code


if __name__ == "__main__":
    sys.exit(main())
