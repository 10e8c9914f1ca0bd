#!/usr/bin/env python3
"""check_paper.py CSV_FOLDER PAGE: the paper's reproduction against known answers.

The expected numbers come from prototypes written apart from the core (NumPy, SymPy, 40-digit arithmetic), from
the paper's own tables, or from symmetry. Prints "N passed, N failed".
"""

import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools", "paper"))

import write_page  # noqa: E402
from tables import Tables  # noqa: E402

# Every 2.5 cm from 0 to 20; printed to three digits.
FORCE = {
    ("plain", 5): (1, 1, .999, .999, .998, .997, .839, .554, .254),
    ("plain", 10): (1, 1, 1, 1, .999, .997, .995, .989, .486),
    ("plain", 20): (1, 1, 1, 1, 1, .997, .995, .989, .944),
    ("weighted", 5): (1, 1, .865, .726, .590, .461, .325, .176, .053),
    ("weighted", 10): (1, 1, 1, 1, .715, .461, .325, .176, .053),
    ("weighted", 20): (1, 1, 1, 1, .965, .461, .325, .176, .053),
}
# Every 7.5 degrees from 0 to 45.
MOMENT = {
    ("fig9", 10, .2): (1, 1, 1, 1, .913, .461, 0), ("fig9", 10, .1): (1, 1, 1, 1, 1, .923, 0),
    ("fig9", 5, .2): (1, 1, .874, .672, .456, .231, 0),
    ("fig11", 10, .2): (1, 1, 1, 1, 1, .923, 0), ("fig11", 5, .2): (1, 1, 1, 1, .913, .461, 0),
}
# name of the figure: (known answer, tolerance)
FIGURES = {
    "closure_limit_cm/x": (12, 1e-5), "closure_limit_cm/y": (12, 1e-5),
    "closure_limit_cm/z": (23.9, 1e-9), "closure_limit_deg/rotation_x": (45, 1e-5),
    "closure_limit_deg/rotation_y": (45, 1e-5), "closure_limit_deg/rotation_z": (45, 1e-5),
    "closure_limit_deg/grasp_angle": (89, 1e-9),
    # 20,000 random poses: three standard deviations of two such counts are 1.5 of 100.
    "closure_share_percent/40 cm cube; upright": (27.9, 1.5),
    "closure_share_percent/40 cm cube; Rz 60 deg": (0, 1e-9),
    "closure_share_percent/20 cm cube; tilt 30 deg; grasp 30 deg": (38, 1.5),
    "closure_share_percent/40 cm cube; tilt 30 deg; grasp 30 deg": (9.9, 1),
    "scaling_share_percent/both 0.48 m; 4.0 cm": (21.6067, 0.01),
    "connections/paper_determinant": (127.1233, 1e-3), "connections/best_determinant": (364.9892, 1e-3),
    "connections/closed": (32, 0), "connections/better_than_paper": (32, 0),
    "connections/full_rank": (2208, 0), "connections/all": (2520, 0), "connections/better_and_closed": (0, 0),
    "table1/affine_offset_cm": (0.48200, 1e-5), "table1/affine_slope_cm": (0.00262225, 1e-8),
    "table1/affine_rms_cm": (.075, 5e-4), "table1/affine_max_cm": (.136, 1e-3),
    "table1/effective_radius_mm": (8.347, 1e-3), "table1/m2_effective_radius_mm": (8.37, 5e-3),
    "table1/m2_equation_to_column_max_cm": (.57, 5e-3), "table1/m2_max_cm": (.30, 1e-9),
    "table1/mm_per_pulse": (0.0251327, 1e-7),
    "table2_at_20_cm/x": (19.57, 5e-3), "table2_at_20_cm/z": (19.70, 5e-3),
    "table2_max_mm/x": (4.3, .05), "table2_max_mm/z": (3.0, .05),
    "table2/paper_max_mm": (4, 1e-9), "table2/x_model_to_paper_max_mm": (1.9, .1),
    "turned_45_min_deg/M2": (32, .5), "turned_45_max_deg/M2": (47, .5),
    "within_4_mm_percent/M2 profile; upright": (91.6, 1),
    "within_4_mm_percent/M2 profile; tilt 30 deg": (98.3, .5),
    "position_max_mm/M2 profile; upright": (4.4, .05),
    "within_4_mm_percent/3 mm each; random signs; upright": (76, 3.5),
    "rotation_rms_deg/3 mm common; tilt 30 deg": (13, 1.5),
    "capacity_grasp_smallest": (1, 1e-5),
    "grasp_good_percent/exact; upright": (100, 0), "grasp_good_percent/M2; upright": (100, 0),
    # Grip and rotors: 0.06 + 0.017 * (A A^T)_11, and the like.
    "centre_inertia/x": (0.06 + 0.017 * 2.51546, 1e-6),
    "centre_inertia/z": (0.06 + 0.017 * 2.96907, 1e-6),
    "centre_inertia/grasp_angle": (1e-5 + 0.017 * 2.96907 * 0.04**2 / 4, 1e-9),
    "free_hand_least_tension_n/40 cm cube; tilt 30 deg": (0.3, 1e-9),
}


def known_answers(t):
    for name, (value, tolerance) in FIGURES.items():
        yield name, abs(t.number(name) - value) <= tolerance, t.figures[name]
    for (weighting, tension), values in FORCE.items():
        curve = t.capacity("fig6", weighting, tension, 5)
        read = [curve[2.5 * i] for i in range(len(values))]
        yield f"Fig. 6, {weighting}, {tension} N", close(read, values, 6e-4), read
    for (figure, tension, moment), values in MOMENT.items():
        curve = t.capacity(figure, "weighted", tension, moment)
        read = [curve[7.5 * i] for i in range(len(values))]
        yield f"{figure}, {tension} N, {moment} N m", close(read, values, 6e-4), read
    z = t.capacity("fig8", "weighted", 5, 5)
    read = [z[15], z[17.5], z[20]]
    yield "Fig. 8, 5 N", close(read, (1, .815, .508), 6e-4), read
    turned = t.capacity("fx_turned_about_x", "weighted", 10, 5)
    read = [turned[angle] for angle in (30, 37.5, 45, 60, 90)]
    yield "force when turned", close(read, (1, .879, .751, .659, .574), 6e-4), read
    across = t.capacity("fz_negative_along_x", "weighted", 10, -5)
    read = [across[x] for x in (10, 12.5, 15, 17.5, 20)]
    yield "force across", close(read, (1, .862, .813, .761, .709), 6e-4), read


def symmetries(t):
    """What must hold whatever the numbers: the frame is a cube and pole 1 mirrors pole 2."""
    for figure, other, asked in (("fig6", "fig6_y", 5), ("fig7", "fig7_y", -5), ("fig9", "fig9_y", .2),
                                 ("fig10", "fig10_y", -.2)):
        difference = write_page.largest_difference(t, figure, other, asked)
        yield f"{figure}: Y as X", difference <= 1e-7, difference
    for figure, mirror, asked in (("fig6", "fig7", 5), ("fig8", "fig8_negative", 5), ("fig9", "fig10", .2),
                                  ("fig11", "fig12", .2)):
        for tension in (5, 10, 20):
            curve = t.capacity(figure, "weighted", tension, asked)
            mirrored = t.capacity(mirror, "weighted", tension, -asked)
            worst = max(abs(value - mirrored[-at]) for at, value in curve.items())
            yield f"{figure} mirrors {mirror}, {tension} N", worst <= 1e-7, worst
    restoring = min(value for figure in ("fig9", "fig11") for tension in (5, 10, 20)
                    for at, value in t.capacity(figure, "weighted", tension, .2).items() if at <= 0)
    yield "restoring moments are given", restoring >= 1 - 1e-6, restoring
    outward = max(abs(value) for figure in ("fig9", "fig11") for tension in (5, 10, 20)
                  for at, value in t.capacity(figure, "weighted", tension, .2).items() if at >= 45)
    yield "outward moments end at 45 degrees", outward <= 1e-6, outward
    reach, = t.columns("scaling", "closure_reach")
    yield "closure reaches half way in every size", max(abs(r - .5) for r in reach) <= 1e-5, reach
    moments, poles = t.columns("scaling", "moment_x_nm", "pole_half_length_m", sweep="both")
    ratios = [moment / pole for moment, pole in zip(moments, poles)]
    yield "in proportion moments grow with d", max(ratios) / min(ratios) < 1 + 1e-5, ratios
    x, y = (t.rows("centre", dof=dof)[0]["largest_10_n"] for dof in ("x", "y"))
    yield "largest force: Y as X", abs(float(x) / float(y) - 1) <= 1e-5, (x, y)
    closed = [row for row in t.rows("connections") if row["closed"] == "1"]
    yield "the paper's connection leads the closed ones", closed[0]["of_paper"] == "1", closed[0]


def well_formed(t):
    """Every row of a table of the page has as many cells as its head."""
    width = 0
    for line in write_page.page(t).splitlines():
        cells = line.count("|") if line.startswith("|") else 0
        if cells and width and cells != width:
            yield "cells of a table's row", False, line
        width = cells
    yield "tables of the page", True, ""


def page_is_fresh(t, path):
    """The committed page says what was computed now: same words, numbers within rounding."""
    number = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
    with open(path, encoding="utf-8") as file:
        committed = file.read()
    fresh = write_page.page(t)
    same_words = number.split(committed) == number.split(fresh)
    yield "the page's words are those of write_page.py", same_words, "run ./dev paper"
    if same_words:
        pairs = list(zip(map(float, number.findall(committed)), map(float, number.findall(fresh))))
        # Another compiler may round the last printed digit otherwise.
        worst = max(pairs, key=lambda pair: abs(pair[0] - pair[1]) / (1 + abs(pair[1])))
        yield "the page's numbers", abs(worst[0] - worst[1]) <= 0.01 * (1 + abs(worst[1])), worst


def close(read, values, tolerance):
    return len(read) == len(values) and all(abs(a - b) <= tolerance for a, b in zip(read, values))


def main():
    t = Tables(sys.argv[1])
    passed = failed = 0
    for name, good, read in (*known_answers(t), *symmetries(t), *well_formed(t),
                               *page_is_fresh(t, sys.argv[2])):
        passed += good
        failed += not good
        if not good:
            print(f"FAIL {name}: {read}")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
