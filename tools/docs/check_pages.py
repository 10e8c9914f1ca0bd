#!/usr/bin/env python3
"""Checks every Markdown page: check_pages.py [FOLDER]

Every relative link and anchor leads somewhere, every picture exists and has a text for readers who do not see it, every
picture in docs/pictures is used, every code block names its language, and every `./dev COMMAND` and
`./dev stage NAME` exists. FOLDER is a git checkout (default: this one). Addresses of other hosts are not tried.
Prints each complaint as FILE:LINE, then "N passed, N failed", which counts pages and pictures.
"""

import collections
import os
import re
import sys

import markdown_pages

PICTURES = "docs/pictures/"
PICTURE_NAMES = (".png", ".webp", ".svg", ".gif", ".jpg")
COMMAND = re.compile(r"(?:^|[\s;&|(])\./dev\s+([a-z][a-z-]*)(?:[ \t]+([a-z][a-z0-9_]*))?")
SHELLS = ("sh", "bash", "shell", "console")
# Tells of commands that have been renamed since.
HISTORY = "CHANGELOG.md"
# Their links are those of their originals, which tests/check_boundaries.py compares them with.
COPIES = ("addons/spidar_g/LICENSE.md", "addons/spidar_g/THIRDPARTY.md")


def dev_words(root):
    """(commands of ./dev, names of stages)"""
    with open(os.path.join(root, "dev"), encoding="utf-8") as file:
        cases = file.read().split("case $command in")[1]
    commands = set()
    for words in re.findall(r"^([a-z][a-z |-]*)\)", cases, re.M):
        commands.update(word.strip() for word in words.split("|"))
    with open(os.path.join(root, "tools", "dev", "stages.txt"), encoding="utf-8") as file:
        stages = {line.split()[0] for line in file if line.strip() and not line.startswith("#")}
    return commands, stages


def links(page, pages, files, folders):
    for link in page.links:
        target = link.target
        if markdown_pages.is_outside(target):
            continue
        path = page.target_path(target)
        if not target or target.startswith("/"):
            yield link.line, f"the link ({target}) is not relative"
        elif path not in files and path not in folders:
            yield link.line, f"the link {target} leads to no file of the repository"
        elif "#" in target:
            anchor = target.split("#", 1)[1]
            if path not in pages:
                yield link.line, f"the link {target} names an anchor of a file that is no page"
            elif anchor not in pages[path].anchors:
                yield link.line, f"the link {target}: {path} has no heading #{anchor}"


def pictures(page, files):
    for picture in page.pictures:
        if not picture.text.strip():
            yield picture.line, f"the picture {picture.target} has no alternative text"
        if markdown_pages.is_outside(picture.target):
            yield picture.line, f"the picture {picture.target} is on another host"
        elif page.target_path(picture.target) not in files:
            yield picture.line, f"the picture {picture.target} is missing"


def languages(page):
    for block in page.blocks:
        if not block.language:
            yield block.line, "the code block names no language (text if it has none)"


def commands(page, known, stages):
    """Words after ./dev in shell blocks and in code inside lines."""
    texts = [(block.line, block.text) for block in page.blocks if block.language in SHELLS] + page.spans
    for line, text in texts:
        for offset, row in enumerate(text.splitlines()):
            for command, word in COMMAND.findall(row.split(" #")[0]):
                if command not in known:
                    yield line + offset, f"./dev has no command {command}"
                elif command == "stage" and word and word not in stages:
                    yield line + offset, f"./dev has no stage {word}"


def unused_pictures(pages, files):
    """Pictures of docs/pictures that no page shows and none links to."""
    used = set()
    for page in pages.values():
        used |= {page.target_path(part.target) for part in [*page.pictures, *page.links]}
    for path in files:
        if path.startswith(PICTURES) and path.endswith(PICTURE_NAMES) and path not in used:
            yield path


def complaints(root):
    """{file: [(line, text)]}, with an empty list for what is in order."""
    files = set(markdown_pages.tracked_files(root))
    folders = {os.path.dirname(path) for path in files}
    for folder in list(folders):
        while folder:
            folder = os.path.dirname(folder)
            folders.add(folder)
    folders.add(".")
    pages = markdown_pages.read_pages(root, sorted(files))
    known, stages = dev_words(root)
    found = collections.OrderedDict()
    for path, page in pages.items():
        found[path] = []
        if path not in COPIES:
            found[path] += [*links(page, pages, files, folders), *pictures(page, files), *languages(page)]
        if path != HISTORY:
            found[path] += commands(page, known, stages)
    unused = set(unused_pictures(pages, files))
    for path in sorted(files):
        if path.startswith(PICTURES) and path.endswith(PICTURE_NAMES):
            found[path] = [(1, "no page uses this picture")] if path in unused else []
    return found


def main(root):
    found = complaints(root)
    for path, problems in found.items():
        for line, text in sorted(problems):
            print(f"FAIL {path}:{line}: {text}")
    failed = sum(bool(problems) for problems in found.values())
    print(f"{len(found) - failed} passed, {failed} failed")
    return 1 if failed or not found else 0


if __name__ == "__main__":
    sys.exit(main(os.path.abspath(sys.argv[1]) if len(sys.argv) > 1 else markdown_pages.ROOT))
