#!/usr/bin/env python3
"""The class reference against the library that Godot loads: check_class_reference.py GODOT

Godot's own doctool writes what is bound; gdextension/doc_classes/ must have the same names, types and defaults, and
a text for each of them. The last line is "N passed, N failed".
"""

import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
from godot_project import ADDONS, prepare_project  # noqa: E402

PROJECT = os.path.join(HERE, "project")
REFERENCE = os.path.join(os.path.dirname(ADDONS), "gdextension", "doc_classes")
TIME_LIMIT_S = 120
TEXTS = ("brief_description", "description", "member", "constant")


def structure(path):
    """Every element with its attributes, without the texts; order of the file."""
    return [
        (element.tag, tuple(sorted(element.attrib.items())))
        for element in ElementTree.parse(path).getroot().iter()
    ]


def untold(path):
    """Where a text is missing: 'member rate_hz'."""
    root = ElementTree.parse(path).getroot()
    parents = {child: parent for parent in root.iter() for child in parent}
    return [
        f"{element.tag} of {parents[element].get('name') or ''}{element.get('name') or ''}"
        for element in root.iter()
        if element.tag in TEXTS and not (element.text or "").strip() and not element.get("overrides")
    ]


def problems_of(name, written, kept):
    if not os.path.exists(kept):
        return [f"{name} is bound but has no file in gdextension/doc_classes/"]
    bound, told = structure(written), structure(kept)
    problems = [f"{name}: bound, not in the reference: {item}" for item in bound if item not in told]
    problems += [f"{name}: in the reference, not bound: {item}" for item in told if item not in bound]
    return problems + [f"{name}: no text for {item}" for item in untold(kept)]


def main(godot):
    prepare_project(PROJECT, godot)
    passed = failed = 0
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(
            [godot, "--headless", "--path", PROJECT, "--doctool", folder, "--gdextension-docs"],
            timeout=TIME_LIMIT_S, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.STDOUT,
        )
        bound = os.path.join(folder, "doc_classes")
        names = set(os.listdir(bound) if os.path.isdir(bound) else [])
        for name in sorted(names | set(os.listdir(REFERENCE))):
            problems = [f"{name} is in gdextension/doc_classes/ but not bound"]
            if name in names:
                problems = problems_of(name, os.path.join(bound, name), os.path.join(REFERENCE, name))
            for problem in problems:
                print("FAIL", problem)
            passed, failed = (passed, failed + 1) if problems else (passed + 1, failed)
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
