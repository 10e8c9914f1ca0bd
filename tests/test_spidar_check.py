#!/usr/bin/env python3
"""spidar_check fk must fail on wrong data and explain malformed files: altered copies of the reference file.

usage: test_spidar_check.py [path of spidar_check]; exit code 0 when every copy is judged as it should be.
"""
import csv
import os
import random
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PASS, FAIL, UNREADABLE = 0, 1, 2


def altered(rows, header, row, column, value):
    """A copy of `rows` with one field changed."""
    copy = [list(r) for r in rows]
    copy[row][header.index(column)] = value
    return copy


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "build/bin/spidar_check")
    with open(os.path.join(ROOT, "tests/data/fk_public.csv"), newline="") as file:
        header, *rows = csv.reader(file)
    rows = rows[::20]  # every kind is still there
    order = list(range(len(header)))
    random.Random(1).shuffle(order)
    kind = header.index("kind")
    noisy = next(i for i, r in enumerate(rows) if r[kind] == "noise1mm")
    turned = next(i for i, r in enumerate(rows) if r[kind] == "nominal" and float(r[header.index("qx")]))
    shifted = repr(float(rows[0][header.index("z")]) + 1e-12)
    shifted_noisy = repr(float(rows[noisy][header.index("r2x")]) + 2e-9)
    other_turn = repr(-float(rows[turned][header.index("qx")]))
    cases = [  # name, header, rows, exit code, text in the output
        ("as given", header, rows, PASS, "failures 0"),
        ("columns in another order", [header[i] for i in order],
         [[r[i] for i in order] for r in rows], PASS, "failures 0"),
        ("one more column", header + ["remark"], [r + ["x"] for r in rows], PASS, "failures 0"),
        ("a byte order mark", ["\ufeff" + header[0], *header[1:]], rows, PASS, "failures 0"),
        ("z off by 1e-12 m", header, altered(rows, header, 0, "z", shifted), FAIL, "position"),
        ("noisy r2x off by 2e-9 m", header,
         altered(rows, header, noisy, "r2x", shifted_noisy), FAIL, "r2"),
        ("another rotation", header, altered(rows, header, turned, "qx", other_turn), FAIL, "rotation"),
        ("impossible lengths", header, altered(rows, header, 0, "l3", "2.5"), FAIL, "refused"),
        ("no rows", header, [], FAIL, "no rows"),
        ("missing column", [h if h != "l4" else "L4" for h in header], rows, UNREADABLE, "'l4'"),
        ("repeated column", header + ["l4"], [r + ["1"] for r in rows], UNREADABLE, "twice"),
        ("not a number", header, altered(rows, header, 2, "psi", "1.5x"), UNREADABLE, "'1.5x'"),
        ("nan", header, altered(rows, header, 2, "l1", "nan"), UNREADABLE, "'nan'"),
        ("empty field", header, altered(rows, header, 2, "l8", ""), UNREADABLE, "'l8'"),
        ("short row", header, rows[:3] + [rows[3][:-1]], UNREADABLE, ":5:"),
    ]
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "fk.csv")
        for name, names, lines, code, text in cases:
            with open(path, "w", encoding="utf-8", newline="") as file:
                csv.writer(file).writerows([names, *lines])
            run = subprocess.run([program, "fk", path], capture_output=True, text=True, check=False)
            good = run.returncode == code and text in run.stdout + run.stderr
            wrong += not good
            print(f"{'ok  ' if good else 'FAIL'} {name}: exit code {run.returncode}, wanted {code}")
            if not good:
                print(run.stdout + run.stderr)
        for arguments in (["fk", os.path.join(folder, "absent.csv")], ["fk"], ["other", path], []):
            run = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
            good = run.returncode == UNREADABLE and bool(run.stderr)
            wrong += not good
            print(f"{'ok  ' if good else 'FAIL'} arguments {arguments[:1]}: exit code {run.returncode}")
    print(f"{wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
