#!/usr/bin/env python3
"""Draws places of the project's text for the reading test: comments of headers, sentences of pages, texts of class help.

draw_places.py SEED [COUNT]      COUNT of each kind, 20 without it

A reader who has never seen the project says of each place what it means. Prints the places as Markdown.
"""

import pathlib
import random
import re
import subprocess
import sys

import class_help

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHORTEST_COMMENT = 30
SHORTEST_SENTENCE = 40


def tracked(*patterns):
    output = subprocess.run(["git", "ls-files", *patterns], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [ROOT / name for name in output.split("\n") if name]


def comments():
    """A block of whole comment lines, with the two lines of code that follow it."""
    found = []
    for path in tracked("gdextension/**/*.h"):
        lines = path.read_text(encoding="utf-8").split("\n")
        row = 0
        while row < len(lines):
            first = row
            while row < len(lines) and lines[row].strip().startswith("//"):
                row += 1
            text = " ".join(line.strip().lstrip("/ ") for line in lines[first:row])
            if len(text) >= SHORTEST_COMMENT and first > 0:
                code = "\n".join(line.strip() for line in lines[row:row + 2] if line.strip())
                found.append((f"{path.relative_to(ROOT)}:{first + 1}", f"{text}\n\n    " + code.replace("\n", "\n    ")))
            row = max(row, first + 1)
    return found


def sentences():
    """A sentence of a page, with its paragraph before it."""
    found = []
    for path in tracked("docs/**/*.md", "README.md", "CONTRIBUTING.md", "addons/**/*.md"):
        inside = False
        for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
            if line.startswith("```"):
                inside = not inside
            if inside or line.startswith(("#", "|", "```", "!")):
                continue
            parts = re.split(r"(?<=[.!?]) (?=[A-Z`])", line.strip())
            for i, part in enumerate(parts):
                if len(part) >= SHORTEST_SENTENCE:
                    before = " ".join(parts[:i])
                    found.append((f"{path.relative_to(ROOT)}:{number}", f"({before}) **{part}**" if before else f"**{part}**"))
    return found


def help_texts():
    found = []
    for each in class_help.read_folder(class_help.LIBRARY):
        found += [(f"{each.name}.{item.name}", " ".join(item.text.split())) for item in each.items]
    for path in tracked("addons/spidar_g/nodes/*.gd"):
        lines = path.read_text(encoding="utf-8").split("\n")
        for row, line in enumerate(lines):
            match = re.match(r"(?:@export.*|static )?(?:var|func|signal|const) (\w+)", line)
            first = row
            while first > 0 and lines[first - 1].startswith("##"):
                first -= 1
            if match and first < row:
                text = " ".join(part.lstrip("# ") for part in lines[first:row])
                found.append((f"{path.stem}.{match.group(1)}", text))
    return found


def main():
    seed = int(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    draw = random.Random(seed)
    for title, places in (("Comments", comments()), ("Pages", sentences()), ("Class help", help_texts())):
        print(f"# {title}: {count} of {len(places)}, seed {seed}\n")
        for number, (place, text) in enumerate(draw.sample(places, count), 1):
            print(f"{number}. `{place}`: {text}\n")


if __name__ == "__main__":
    main()
