#!/usr/bin/env python3
"""The steps of ./dev release: release.py check VERSION | finish VERSION ZIP, each with --skip-tests for a trial

check: version.py and CHANGELOG.md have the version, git has no tag of it, and nothing is left uncommitted. A trial lets
the section of CHANGELOG.md be unreleased.
finish: ZIP is of this version and whole; dist/release_notes-VERSION.md gets the section of CHANGELOG.md; then the steps
that are left to do by hand are printed.
"""

import hashlib
import os
import re
import subprocess
import sys
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ADDON = "addons/spidar_g/"


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def git(*words):
    return subprocess.run(["git", *words], cwd=ROOT, check=True, text=True, capture_output=True).stdout.strip()


def section(version):
    """(what follows the version in its heading, the text below) of CHANGELOG.md; None if it has no such heading."""
    found = re.search(rf"^## \[{re.escape(version)}\]([^\n]*)\n(.*?)(?=^## |\Z)", read("CHANGELOG.md"), re.M | re.S)
    return (found.group(1).strip(" -"), found.group(2).strip()) if found else None


def faults(version, trial):
    """What forbids a release, as sentences."""
    if not re.fullmatch(r"\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?", version):
        yield f"{version} is no version of the form 1.2.3"
        return
    has = re.search(r'^version = "(.*)"', read("version.py"), re.M).group(1)
    if has != version:
        yield f"version.py says {has}"
    if f'version="{version}"' not in read(ADDON + "plugin.cfg"):
        yield f"{ADDON}plugin.cfg has another version"
    changes = section(version)
    if changes is None:
        yield f"CHANGELOG.md has no section [{version}]"
    elif not changes[1]:
        yield f"the section [{version}] of CHANGELOG.md is empty"
    elif not trial and not re.fullmatch(r"\d{4}-\d\d-\d\d", changes[0]):
        yield f"the section [{version}] of CHANGELOG.md has no date: {changes[0]}"
    if git("status", "--porcelain"):
        yield "git has changes that are not committed"
    if git("tag", "--list", f"v{version}"):
        yield f"git has a tag v{version} already"


def zip_faults(version, path):
    if os.path.basename(path) != f"spidar_g-{version}.zip":
        yield f"{path} is not named spidar_g-{version}.zip"
    with zipfile.ZipFile(path) as archive:
        names = set(archive.namelist())
        wanted = {ADDON + name for name in ("plugin.cfg", "spidar_g.gdextension", "README.md", "LICENSE.md")}
        if ADDON + "spidar_g.gdextension" in names:
            manifest = archive.read(ADDON + "spidar_g.gdextension").decode()
            wanted |= {ADDON + name for name in re.findall(r'^\w+\.(?:debug|release)\.\w+ = "(.*)"', manifest, re.M)}
        for name in sorted(wanted - names):
            yield f"{path} has no {name}"
        if ADDON + "plugin.cfg" in names and f'version="{version}"' not in archive.read(ADDON + "plugin.cfg").decode():
            yield f"{path} holds another version"


def write_notes(version):
    path = os.path.join("dist", f"release_notes-{version}.md")
    os.makedirs(os.path.join(ROOT, "dist"), exist_ok=True)
    with open(os.path.join(ROOT, path), "w", encoding="utf-8") as file:
        file.write(f"# spidar_g {version}\n\n{section(version)[1]}\n")
    return path


def print_rest(version, path, notes, trial):
    with open(path, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()
    steps = [f"Read {notes}: these are the notes of the release.",
             f"git tag -a v{version} -m 'spidar_g {version}' {git('rev-parse', '--short', 'HEAD')}",
             f"git push origin v{version}",
             f"Make a release of the tag on the forge, with the notes and {os.path.relpath(path, ROOT)} (sha256 {digest}).",
             "Publish build/site, which ./dev docs builds.",
             "Begin the next version: version.py, addons/spidar_g/plugin.cfg and a section of CHANGELOG.md that is unreleased."]
    if trial:
        steps.insert(0, f"This was a trial: no test ran. Date the section [{version}] of CHANGELOG.md, commit, and run "
                        f"./dev release {version}.")
    print("\nLeft to do by hand:")
    for number, step in enumerate(steps, 1):
        print(f"{number}. {step}")


def main(arguments):
    trial = "--skip-tests" in arguments
    action, version, *more = [word for word in arguments if word != "--skip-tests"]
    found = list(faults(version, trial))
    if action == "finish" and not found:
        found = list(zip_faults(version, more[0]))
    for fault in found:
        print(f"release: {fault}", file=sys.stderr)
    if found:
        return 1
    if action == "finish":
        print_rest(version, more[0], write_notes(version), trial)
    return 0


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in ("check", "finish"):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
