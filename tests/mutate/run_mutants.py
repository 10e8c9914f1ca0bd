#!/usr/bin/env python3
"""Do the tests notice when a source is changed? run_mutants.py --count N --seed S [--room core/tension] [--jobs N]

Draws N mutants of gdextension/core and gdextension/device, builds spidar_tests with each, in a copy of the tree under
build/mutate, and tells which of its test cases notices. The same tree, count and seed give the same mutants.

  killed        a test case fails, crashes or does not end, and does so again when it is run again
  survived      all test cases pass: a check is missing, or the mutant means the same as the original
  equivalent    the compiler makes the same code of it: not counted
  not compiled  another mutant is drawn in its place

Other ways to choose: --files PATH..., --changed RANGE (the sources that a git range changed), --only NAME... (the name
that a run printed; these mutants alone), --list (print what would be drawn and build nothing).
--at-least P ends with exit code 1 when fewer than P percent are killed.
What was found is kept in build/mutate/results.jsonl for as long as the program stays the same; --again forgets it.
The last line is "killed K of M real mutants (P %)".
"""

import argparse
import collections
import concurrent.futures
import json
import os
import queue
import subprocess
import sys
import time

import mutants
import scratch_build
import test_runs

SOURCE_ROOTS = ("gdextension/core", "gdextension/device")
NOT_COMPILED, EQUIVALENT, KILLED, SURVIVED = "not compiled", "equivalent", "killed", "survived"

Result = collections.namedtuple("Result", "outcome by took_s")


def log(*words):
    print(*words, flush=True)


# --- Which mutants ---------------------------------------------------------------------------------


def sources_of(root, options):
    """The sources to mutate, as the options say."""
    found = [path for path in scratch_build.tree_files(root)
             if path.startswith(tuple(folder + "/" for folder in SOURCE_ROOTS)) and path.endswith((".cpp", ".h"))]
    if options.room:
        room = options.room.rstrip("/") + "/"
        found = [path for path in found if path.startswith((room, "gdextension/" + room))]
    if options.changed:
        command = ["git", "diff", "--name-only", "--no-renames", "-z", options.changed, "--"]
        done = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True)
        options.files = (options.files or []) + done.stdout.split("\0")
    if options.files is not None:
        found = [path for path in found if path in options.files]
    return found


def drawn(root, options):
    """All mutants of the chosen sources, in the order of the draw."""
    everything = []
    for path in sources_of(root, options):
        with open(os.path.join(root, path), encoding="utf-8") as file:
            everything += mutants.all_mutants(path, file.read())
    return mutants.in_drawn_order(everything, options.seed)


def named(root, names):
    """The mutants of these names."""
    found = []
    for name in names:
        path = name.split(":")[0]
        with open(os.path.join(root, path), encoding="utf-8") as file:
            there = mutants.all_mutants(path, file.read())
        match = [mutant for mutant in there if mutant.name == name]
        if not match:
            line = name.split(":")[1:2]
            others = [mutant.name for mutant in there if [str(mutant.line)] == line]
            sys.exit(f"run_mutants.py: no mutant {name}; on this line there are:\n" + "\n".join(others))
        found += match
    return found


# --- One mutant ------------------------------------------------------------------------------------


def evaluate(mutant, base, suite, worker):
    """(outcome, by what it was killed)."""
    worker.begin(mutant.path, mutant.text)
    users = base.users[mutant.path]
    sources = [item for item in users if not item.source.startswith("tests/")]
    tests = [item for item in users if item.source.startswith("tests/")]
    if not users or worker.compile(sources):
        return NOT_COMPILED, ""
    near = suite.near(mutant.path)
    # A header's other tests are compiled once the near ones have passed. They are not run before: a test that was
    # compiled with the old header may fail where the two do not fit together.
    first = [item for item in tests if item.source in near or item.source.startswith("tests/support/")]
    later = [item for item in tests if item not in first]
    unsteady = []
    for items, files in ((first, near), (later, [file for file in suite.ordered(mutant.path) if file not in near])):
        if worker.compile(items):
            return NOT_COMPILED, ""
        if not worker.replaced or not files:
            continue
        worker.link()
        for file in files:
            run = suite.try_file(worker.program, file, worker.tree, worker.temporary)
            if run.verdict == "unsteady":
                unsteady.append(f"{run.case} ({file})")
            elif run.verdict != "passed":
                return KILLED, f"{run.case or 'the program'} ({file}), {run.verdict}"
    if not worker.replaced:
        return EQUIVALENT, ""
    return SURVIVED, "failed once, then passed: " + "; ".join(unsteady) if unsteady else ""


# --- All of them -----------------------------------------------------------------------------------


class Memory:
    """Results of earlier runs with the same program."""

    def __init__(self, path, digest, forget):
        self.path = path
        self.digest = digest
        self.known = {}
        if not forget and os.path.isfile(path):
            with open(path, encoding="utf-8") as file:
                for entry in map(json.loads, file):
                    if entry["program"] == digest:
                        self.known[entry["name"], entry["diff"]] = Result(*entry["result"])

    def find(self, mutant):
        return self.known.get((mutant.name, mutant.diff()))

    def add(self, mutant, result):
        entry = {"program": self.digest, "name": mutant.name, "diff": mutant.diff(), "result": result}
        with open(self.path, "a", encoding="utf-8") as file:
            file.write(json.dumps(entry) + "\n")


def run_all(stream, count, jobs, evaluate_one):
    """[(mutant, result)] of the first mutants of the stream, until `count` of them have compiled."""
    stream = iter(stream)
    results, waiting = [], {}
    compiled = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        while True:
            while compiled + len(waiting) < count and len(waiting) < jobs:
                mutant = next(stream, None)
                if mutant is None:
                    break
                results.append([mutant, None])
                waiting[pool.submit(evaluate_one, mutant)] = results[-1]
            if not waiting:
                return results
            done, _ = concurrent.futures.wait(waiting, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in done:
                entry = waiting.pop(future)
                entry[1] = future.result()
                compiled += entry[1].outcome != NOT_COMPILED
                tell(entry[0], entry[1], compiled, count)


def tell(mutant, result, compiled, count):
    log(f"{compiled:3}/{count} {result.outcome:12} {result.took_s:6.1f} s  {mutant.name}")
    if result.by:
        log(f"        {result.by}")


def report(results):
    """Prints the survivors and the totals; returns the share of the killed, in percent."""
    number = collections.Counter(result.outcome for _, result in results)
    for mutant, result in results:
        if result.outcome == SURVIVED:
            log(f"\nsurvived: {mutant.name}\n{mutant.diff()}")
    log()
    families = collections.defaultdict(collections.Counter)
    for mutant, result in results:
        families[mutant.family][result.outcome] += 1
    for family, counts in sorted(families.items()):
        if counts[KILLED] + counts[SURVIVED]:
            log(f"{family:15} killed {counts[KILLED]} of {counts[KILLED] + counts[SURVIVED]}")
    took_s = sum(result.took_s for _, result in results) / max(1, len(results))
    log(f"{number[EQUIVALENT]} equivalent, {number[NOT_COMPILED]} not compiled, {took_s:.1f} s each")
    real = number[KILLED] + number[SURVIVED]
    share = 100.0 * number[KILLED] / real if real else 0.0
    log(f"killed {number[KILLED]} of {real} real mutants ({share:.0f} %)")
    return share


def run(root, options):
    chosen = named(root, options.only) if options.only else drawn(root, options)
    if not chosen:
        log("no mutants: the options choose no source of " + " or ".join(SOURCE_ROOTS))
        return 0 if options.changed else 2
    count = len(chosen) if options.only else options.count
    if options.list:
        for mutant in chosen[:count]:
            log(f"{mutant.name}\n{mutant.diff()}")
        return 0
    home = os.path.join(root, "build", "mutate")
    log(f"seed {options.seed}, {len(chosen)} mutants to draw from")
    log(f"building the unmutated tree in {os.path.relpath(home)}")
    base = scratch_build.BaseBuild(root, home, options.jobs)
    suite = test_runs.Suite(base, home, log)
    workers = queue.Queue()
    for number in range(options.jobs):
        workers.put(scratch_build.Worker(base, os.path.join(home, f"worker{number}")))
    memory = Memory(os.path.join(home, "results.jsonl"), base.digest, options.again)

    def evaluate_one(mutant):
        result = memory.find(mutant)
        if result is None:
            worker = workers.get()
            started = time.monotonic()
            try:
                outcome, by = evaluate(mutant, base, suite, worker)
            finally:
                workers.put(worker)
            result = Result(outcome, by, round(time.monotonic() - started, 1))
            memory.add(mutant, result)
        return result

    results = run_all(chosen, count, options.jobs, evaluate_one)
    for path in suite.failing:
        log(f"not used, since it fails without a mutant: {path}")
    share = report(results)
    return 1 if share < options.at_least else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--room", default="", help="core, device or a room of theirs, like core/tension")
    parser.add_argument("--files", nargs="+")
    parser.add_argument("--changed", metavar="RANGE")
    parser.add_argument("--only", nargs="+", metavar="NAME")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--at-least", type=float, default=0.0, metavar="P")
    parser.add_argument("--root", default=os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))),
                        help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.count < 1 or options.jobs < 1:
        parser.error("--count and --jobs are at least 1")
    try:
        return run(os.path.abspath(options.root), options)
    except (scratch_build.BuildError, test_runs.NoTests) as error:
        sys.exit(f"run_mutants.py: {error}")


if __name__ == "__main__":
    sys.exit(main())
