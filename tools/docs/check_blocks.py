#!/usr/bin/env python3
"""Checks every `gdscript` block of every Markdown page: check_blocks.py GODOT [FOLDER]

A block is run by a test of tests/godot/project that names its page, or it parses in a Godot that has the add-on: as a
script, as members of a Node3D, or as the lines of a function of one. FOLDER is a git checkout (default: this one).
Prints each complaint as FILE:LINE, then "N passed, N failed", which counts pages.
"""

import glob
import json
import os
import subprocess
import sys
import tempfile

import markdown_pages

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(markdown_pages.ROOT, "tests"))
import godot_project  # noqa: E402

PROJECT = os.path.join("tests", "godot", "project")
LIMIT_S = 60
MEMBERS = "extends Node3D\n"
# A line of an example may use the device that the page made before.
LINES = MEMBERS + "var device: SpidarG\nvar hand: SpidarGHand\nfunc _example() -> void:\n"


def test_texts(root):
    texts = []
    for path in sorted(glob.glob(os.path.join(glob.escape(root), PROJECT, "*.gd"))):
        with open(path, encoding="utf-8") as file:
            texts.append(file.read())
    return texts


def is_run(path, tests):
    """Whether a test names the page: by its path in the repository, or a page of docs by its name alone."""
    name = f'{os.path.basename(path)}"' if path.startswith("docs/") else path
    return any(name in text for text in tests)


def sources(block):
    """What the block may stand for, as whole scripts."""
    text = block.text.replace("    ", "\t")
    indented = "".join(f"\t{line}\n" if line.strip() else "\n" for line in text.splitlines())
    return [text + "\n", MEMBERS + text + "\n", LINES + indented + "\tpass\n"]


def parse(godot, scripts):
    """Whether each of the scripts parses, and what Godot says of them."""
    godot_project.prepare_project(os.path.join(markdown_pages.ROOT, PROJECT), godot)
    with tempfile.TemporaryDirectory() as folder:
        given, told = os.path.join(folder, "scripts.json"), os.path.join(folder, "parsed.json")
        with open(given, "w", encoding="utf-8") as file:
            json.dump(scripts, file)
        done = subprocess.run(
            [godot, "--headless", "--path", os.path.join(markdown_pages.ROOT, PROJECT), "--script",
             os.path.join(HERE, "parse_scripts.gd"), "--", given, told],
            timeout=LIMIT_S, text=True, errors="replace", stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, check=False)
        if not os.path.exists(told):
            raise SystemExit(f"Godot did not parse the blocks:\n{done.stdout[-2000:]}")
        with open(told, encoding="utf-8") as file:
            return json.load(file), done.stdout


def complaints(godot, root):
    """{page: [(line, text)]}, with an empty list for a page whose blocks are in order."""
    tests = test_texts(root)
    found, blocks = {}, []
    for path, page in markdown_pages.read_pages(root).items():
        scripts = [block for block in page.blocks if block.language == "gdscript"]
        if scripts:
            found[path] = []
            if not is_run(path, tests):
                blocks += [(path, block, sources(block)) for block in scripts]
    if blocks:
        parsed, _ = parse(godot, [source for _, _, ways in blocks for source in ways])
        for number, (path, block, ways) in enumerate(blocks):
            if not any(parsed[number * len(ways):(number + 1) * len(ways)]):
                found[path].append((block.line, "the block is run by no test and does not parse"))
    return found


def main(godot, root):
    found = complaints(godot, root)
    for path, problems in found.items():
        for line, text in problems:
            print(f"FAIL {path}:{line}: {text}")
    failed = sum(bool(problems) for problems in found.values())
    print(f"{len(found) - failed} passed, {failed} failed")
    return 1 if failed or not found else 0


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else markdown_pages.ROOT))
