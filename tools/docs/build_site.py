#!/usr/bin/env python3
"""Builds the site of the documentation: build_site.py GODOT PYTHON OUT

PYTHON is one that has tools/docs/site/requirements.txt. Lays every page of the repository, and the class help as pages,
into build/docs, then lets Sphinx make OUT of them. A warning of Sphinx is a failure. OUT needs no server and no network.
"""

import os
import re
import shutil
import subprocess
import sys

import class_help
import class_pages
import markdown_pages

ROOT = markdown_pages.ROOT
STAGE = os.path.join(ROOT, "build", "docs")
HOME = "README.md"
CLASSES = "docs/reference/classes"
SHELVES = ("start", "how_to", "reference", "why")  # their order; the pages of each come from its folder
# The copies that the add-on carries, and what lies beside programs, their results and pictures.
LEFT_OUT = ("addons/spidar_g/LICENSE.md", "addons/spidar_g/THIRDPARTY.md", "tests/", "tools/", "docs/pictures/")
LIMIT_S = 300


def staged_name(path):
    return "index.md" if path == HOME else path


def rewritten(page, pages, files):
    """The page's text with links as they are in the site, and the other files that it needs."""
    needed = set()

    def target_of(target):
        if not target or target.startswith("#") or markdown_pages.is_outside(target):
            return target
        path = page.target_path(target)
        path = f"{path}/README.md".removeprefix("./") if f"{path}/README.md".removeprefix("./") in pages else path
        if path in pages:
            anchor = "#" + target.split("#", 1)[1] if "#" in target else ""
            return os.path.relpath(staged_name(path), os.path.dirname(page.path) or ".") + anchor
        if path not in files or path.endswith(".md"):
            return None
        needed.add(path)
        return target

    def link(found):
        text, target = found.group(1), target_of(found.group(2))
        return text if target is None else f"[{text}]({target})"

    def line_of(line):
        spans = []
        line = markdown_pages.CODE_SPAN.sub(lambda found: spans.append(found.group(0)) or f"\0{len(spans) - 1}\0", line)
        for target in markdown_pages.PICTURE.findall(line):
            target_of(target[1])
        line = markdown_pages.LINK.sub(link, line)
        return re.sub(r"\0(\d+)\0", lambda found: spans[int(found.group(1))], line)

    kept = markdown_pages.split_code(page.text)[0]  # blank where code is, which stays as it is
    lines = [line_of(line) if kept[number] else line for number, line in enumerate(page.text.splitlines())]
    return "\n".join(lines) + "\n", needed


def by_mention(pages, names):
    """Pages in the order in which the home pages first link to them; then by name."""
    places = {}
    for home in ("docs/README.md", HOME):
        for link in pages[home].links if home in pages else ():
            places.setdefault(pages[home].target_path(link.target), len(places))
    return sorted(names, key=lambda path: (os.path.basename(path) != "README.md", places.get(path, len(places)), path))


def toctree(caption, names):
    title = [f":caption: {caption}"] if caption else []
    return "\n".join(["", "```{toctree}", ":hidden:", *title, "", *[name.removesuffix(".md") for name in names], "```", ""])


def navigation(pages):
    """The lists of pages for the home page: one for each folder of docs, one for what is about the project."""
    found = {path.split("/")[1] for path in pages if path.startswith("docs/") and path.count("/") > 1}
    text = toctree("", [path for path in pages if path.startswith("docs/") and path.count("/") == 1])
    for shelf in [*SHELVES, *sorted(found - set(SHELVES))]:
        names = by_mention(pages, [path for path in pages if path.startswith(f"docs/{shelf}/")])
        if shelf == "reference":
            names.append(f"{CLASSES}/index.md")
        if names:
            text += toctree(shelf.replace("_", " ").capitalize(), names)
    others = [path for path in pages if not path.startswith("docs/") and path != HOME]
    return text + toctree("Project", by_mention(pages, others))


def lay_pages(files):
    """Fills STAGE."""
    shutil.rmtree(STAGE, ignore_errors=True)
    pages = {path: page for path, page in markdown_pages.read_pages(ROOT, files).items() if not path.startswith(LEFT_OUT)}
    needed = set()
    for path, page in pages.items():
        text, others = rewritten(page, pages, set(files))
        needed |= others
        target = os.path.join(STAGE, staged_name(path))
        os.makedirs(os.path.dirname(target), exist_ok=True)
        with open(target, "w", encoding="utf-8") as file:
            file.write(text + (navigation(pages) if path == HOME else ""))
    for path in needed:
        os.makedirs(os.path.join(STAGE, os.path.dirname(path)), exist_ok=True)
        shutil.copy(os.path.join(ROOT, path), os.path.join(STAGE, path))


def version():
    with open(os.path.join(ROOT, "version.py"), encoding="utf-8") as file:
        return re.search(r'^version = "(.*)"', file.read(), re.M).group(1)


def main(godot, python, out):
    lay_pages(markdown_pages.tracked_files(ROOT))
    class_pages.write(class_help.read_all(godot), os.path.join(STAGE, CLASSES))
    shutil.rmtree(out, ignore_errors=True)
    command = [python, "-m", "sphinx", "-q", "-W", "--keep-going", "-E", "-d", os.path.join(STAGE, ".doctrees"),
               "-c", os.path.join(ROOT, "tools", "docs", "site"), STAGE, out]
    return subprocess.run(command, timeout=LIMIT_S, check=False, stdin=subprocess.DEVNULL,
                          env={**os.environ, "SPIDAR_G_VERSION": version()}).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], os.path.abspath(sys.argv[3])) if len(sys.argv) == 4 else __doc__)
