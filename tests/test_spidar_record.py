#!/usr/bin/env python3
"""spidar_record on a recording of another process: test_spidar_record.py BIN_FOLDER

The last line is "N passed, N failed".
"""

import csv
import io
import os
import subprocess
import sys
import tempfile
import zlib

SECONDS = 6
CYCLES = SECONDS * 1000
failures = []
checks = 0


def check(condition, message):
    global checks
    checks += 1
    if not condition:
        failures.append(message)
        print("FAIL", message)


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, timeout=300)


def check_csv(tool, path):
    done = run(tool, "csv", path)
    check(done.returncode == 0, f"csv ends with 0: {done.stderr}")
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    check(len(rows) == CYCLES, f"{len(rows)} rows for {CYCLES} cycles")
    check([int(row["tick"]) for row in rows] == list(range(1, CYCLES + 1)), "ticks count up")
    check(all(float(row["dt_s"]) == 0.001 for row in rows), "1 ms each")
    moved = max(float(row["y_m"]) for row in rows) - min(float(row["y_m"]) for row in rows)
    check(0.01 < moved < 0.2, f"the grip moved {moved} m along y")
    # Lengths and counts are one and the same thing in two units.
    worst = 0.0
    first = rows[0]
    for row in rows[::100]:
        for i in range(8):
            counts = int(row[f"count_{i}"]) - int(first[f"count_{i}"])
            metres = float(row[f"length_m_{i}"]) - float(first[f"length_m_{i}"])
            worst = max(worst, abs(metres - 2.513274122871834e-5 * counts))
    check(worst < 2e-7, f"lengths follow the counts (worst {worst} m)")
    pulled = [float(row[f"tension_n_{i}"]) for row in rows for i in range(8)]
    check(0.0 <= min(pulled) and 0.3 < max(pulled) <= 10.0, "tensions are within their limits")


def check_another_build(tool, whole, path):
    """The same recording as if by a build of another name: opened, printed with its poses, and not said to be exact."""
    head, size = 8, int.from_bytes(whole[13:17], "little")
    text = bytearray(whole[17:17 + size])
    digit = text.index(b"\nbuild=") + len(b"\nbuild=")
    text[digit] = ord("1" if text[digit] == ord("0") else "0")
    chunk = whole[head:17] + bytes(text)
    with open(path, "wb") as file:
        file.write(whole[:head] + chunk + zlib.crc32(chunk).to_bytes(4, "little") + whole[17 + size + 4:])
    done = run(tool, "info", path)
    check(done.returncode == 0 and "replays the poses only" in done.stdout, f"info of another build: {done.stdout[:300]}")
    done = run(tool, "verify", path)
    check(done.returncode == 1 and "another build" in done.stderr, f"verify of another build: {done.stderr}")
    done = run(tool, "csv", path)
    rows = list(csv.DictReader(io.StringIO(done.stdout)))
    check(done.returncode == 0 and len(rows) == CYCLES, f"csv of another build: {done.returncode}, {len(rows)} rows")
    check([int(row["tick"]) for row in rows] == list(range(1, CYCLES + 1)), "its ticks count up")
    moved = max(float(row["y_m"]) for row in rows) - min(float(row["y_m"]) for row in rows)
    check(0.01 < moved < 0.2, f"its grip moved {moved} m along y")
    check(all(row["fx_n"] == "" and row["given_grasp_nm"] == "" for row in rows), "no wrenches are made up")


def main(folder):
    tool = os.path.join(folder, "spidar_record")
    with tempfile.TemporaryDirectory() as place:
        path = os.path.join(place, "run.rec")
        made = run(os.path.join(folder, "stress_replay"), "--seconds", str(SECONDS), "--seed", "3",
                   "--keep", path)
        check(os.path.isfile(path), f"a recording is made: {made.stdout}")
        done = run(tool, "verify", path)
        check(done.returncode == 0, f"verify ends with 0: {done.stderr}")
        check(f"{CYCLES} cycles replayed, 0 with other bits, 0 missing" in done.stderr, "verify counts")
        done = run(tool, "info", path)
        check(done.returncode == 0, f"info ends with 0: {done.stderr}")
        check(f"{CYCLES} cycles, {SECONDS}.000 s, 1 segments" in done.stdout, f"info: {done.stdout[-200:]}")
        check("Active: forces are rendered." in done.stdout, "info tells events")
        check_csv(tool, path)
        with open(path, "rb") as file:
            whole = file.read()
        cut = os.path.join(place, "cut.rec")
        with open(cut, "wb") as file:
            file.write(whole[: len(whole) * 2 // 3])
        check_another_build(tool, whole, os.path.join(place, "other.rec"))
        for command in ("info", "csv", "verify"):
            done = run(tool, command, cut)
            check(done.returncode == 1, f"{command} of a cut file ends with 1")
            check("is cut off at byte" in done.stderr, f"and says so: {done.stderr}")
        done = run(tool, "info", os.path.join(place, "absent.rec"))
        check(done.returncode == 1 and "does not exist" in done.stderr, f"no file: {done.stderr}")
        for arguments in ([], ["info"], ["play", path]):
            check(run(tool, *arguments).returncode == 2, f"usage: {arguments}")
    print(f"{checks - len(failures)} passed, {len(failures)} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
