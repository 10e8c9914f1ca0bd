#!/usr/bin/env python3
"""Tests of the binding that the last build used: run_binding_tests.py GODOT PROBE_LIB [--update-golden]

GODOT is a Godot 4 editor binary, PROBE_LIB the library that tests/binding/SConscript builds. With a godot-cpp, what only
the in-tree binding promises is left out and named. The last line is "N passed, N failed"; the exit code is 0 only when
nothing failed.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BINDING = ROOT / "gdextension" / "binding"
RUN_LIMIT_S = 120  # a run takes seconds; a hung Godot must not hold the tests

sys.path.insert(0, str(HERE))
import generator_cases  # noqa: E402
import godot_cpp_cases  # noqa: E402
import refusal_cases  # noqa: E402
import snippet_cases  # noqa: E402

# What project/ makes the binding print, and how often: (text, times); the second with the in-tree binding only.
EXPECTED_MESSAGES = (
    ("rate_hz is nan Hz: it must be above 0.", 1),
    ("String 8 does not exist.", 1),
)
IN_TREE_MESSAGES = (
    ("Node3D.get_phantom (hash 12345) is not in this Godot", 1),
    ("Array.phantom_sort (hash 12345) is not in this Godot", 1),
    ("The virtual method _changed has other arguments in this Godot", 1),
    ("An engine method was called on an object that the engine did not make", 2),
    ("'Probe::sum': Method expected 1 argument(s), but called with 0.", 1),
    ("'Probe::sum': Method expected 3 argument(s), but called with 4.", 1),
)
# What a sound run never prints.
FORBIDDEN = re.compile(
    r"SCRIPT ERROR|leaked|still in use at exit|Orphan StringName|BUG:|unclaimed string|"
    r"runtime error:|ERROR: AddressSanitizer|handle_crash")


class Tally:
    """Counts checks and says which failed."""

    def __init__(self):
        self.passed = 0
        self.failed = 0

    def check(self, good, what):
        if good:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAIL {what}")


def make_project(folder, library):
    """A copy of project/ with the probe beside it. The list of extensions is written here: a headless
    Godot that meets an extension for the first time crashes when it ends."""
    shutil.copytree(HERE / "project", folder)
    suffix = Path(library).suffix
    shutil.copyfile(library, folder / f"probe_library{suffix}")
    (folder / ".godot").mkdir()
    (folder / ".godot" / "extension_list.cfg").write_text("res://probe.gdextension\n")


def run_godot(godot, project, home, *arguments):
    """Exit code and whole output; a Godot that hangs counts as exit code 124."""
    environment = dict(os.environ, HOME=str(home), XDG_DATA_HOME=str(home / "data"))
    command = [godot, "--headless", "--path", str(project), *arguments]
    try:
        done = subprocess.run(command, timeout=RUN_LIMIT_S, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env=environment, check=False)
        return done.returncode, done.stdout
    except subprocess.TimeoutExpired as late:
        return 124, late.stdout.decode(errors="replace") if late.stdout else ""


def script_tests(tally, godot, project, home, in_tree):
    code, output = run_godot(godot, project, home, "--verbose", "--script", "res://run_tests.gd")
    for line in output.splitlines():
        if line.startswith("FAIL "):
            print(line)
    totals = re.search(r"^(\d+) passed, (\d+) failed$", output, re.MULTILINE)
    if not totals:
        print(output)
        tally.check(False, f"the scripts did not run to their end (exit code {code})")
        return
    tally.passed += int(totals.group(1))
    tally.failed += int(totals.group(2))
    tally.check(code == (0 if totals.group(2) == "0" else 1), f"exit code of the scripts: {code}")
    scripts = {path.name for path in (HERE / "project").glob("test_*.gd")} - {"test_case.gd"}
    listed = set(re.findall(r"res://(test_\w+\.gd)",
                            (HERE / "project" / "run_tests.gd").read_text())) - {"test_case.gd"}
    tally.check(scripts == listed, f"run_tests.gd lists {listed}, the folder holds {scripts}")
    for text, times in EXPECTED_MESSAGES + (IN_TREE_MESSAGES if in_tree else ()):
        found = output.count(text)
        tally.check(found == times, f"message {found} times instead of {times}: {text}")
    bad = [line for line in output.splitlines() if FORBIDDEN.search(line)]
    tally.check(not bad, "a sound run does not print:\n  " + "\n  ".join(bad))


def unload_tests(tally, godot, project, home):
    """The engine goes on when it unloads the library, and can load it again."""
    code, output = run_godot(godot, project, home, "--script", "res://unload.gd")
    tally.check(code == 0 and "\nunloaded 3 times\n" in output and not FORBIDDEN.search(output),
                f"unloaded, loaded again and ended: exit code {code}\n{output}")


def golden_tests(tally, godot, project, home, update, in_tree):
    """The whole bound API, as Godot describes it."""
    out = home / "doc"
    out.mkdir()
    code, output = run_godot(godot, project, home, "--doctool", str(out), "--gdextension-docs")
    made = {path.name: path.read_text() for path in (out / "doc_classes").glob("*.xml")}
    if update:
        for name, text in made.items():
            (HERE / "golden" / name).write_text(text)
    golden = {path.name: path.read_text() for path in (HERE / "golden").glob("*.xml")
              if in_tree or path.stem != "ProbeFaults"}
    tally.check(code == 0 and made, f"--doctool: exit code {code}\n{output if code else ''}")
    tally.check(made.keys() == golden.keys(), f"classes {sorted(made)} not {sorted(golden)}")
    for name in sorted(made.keys() & golden.keys()):
        differing = [f"{new.strip()} instead of {old.strip()}" for new, old in
                     zip(made[name].splitlines(), golden[name].splitlines()) if new != old]
        tally.check(made[name] == golden[name],
                    f"{name} is not the golden one: {differing[:3] or 'other length'}")


def allowed_name_tests(tally):
    """Our sources and the probe reach nothing that real godot-cpp lacks, and lean on no binding's check of arguments."""
    inside = re.compile(r"\binternal::|GODOT_BINDING_|godot_cpp/internal|\.gen\.")
    nodes = [path for path in (ROOT / "gdextension" / "godot").rglob("*") if path.is_file()]
    sources = [*nodes, HERE / "probe.hpp", HERE / "probe.cpp",
               HERE / "register_types.cpp"]
    readme = (BINDING / "README.md").read_text()
    unchecked = re.compile(r'bind_(?:static_)?method\((?:get_class_static\(\),\s*|"\w+",\s*)?(?:\w+::)?D_METHOD\("\w+",')
    bindings = 0
    for path in nodes:
        text = re.sub(r"\s+", " ", path.read_text())
        bindings += len(re.findall(r"\bbind_checked<", text))
        tally.check(not unchecked.search(text), f"{path.name} binds a method with arguments without bind_checked")
    tally.check(bindings > 20, f"methods with arguments are bound by bind_checked: {bindings}")
    for path in sources:
        text = path.read_text()
        tally.check(not inside.search(text), f"{path.name} uses the inside of the binding")
        unlisted = [header for header in re.findall(r"#include <(godot_cpp/[^>]+)>", text)
                    if f"`{header.removeprefix('godot_cpp/')}`" not in readme]
        tally.check(not unlisted, f"{path.name} includes {unlisted}, not listed in README.md")


def main(arguments):
    update = "--update-golden" in arguments
    arguments = [a for a in arguments if a != "--update-golden"]
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    godot, library = shutil.which(arguments[0]), Path(arguments[1])
    if not godot or not library.is_file():
        print(f"run_binding_tests.py: {arguments[0 if not godot else 1]}: no such "
              f"{'program' if not godot else 'file'}", file=sys.stderr)
        return 2
    with open(ROOT / "build" / "binding" / "in_use.json", encoding="utf-8") as file:
        binding = json.load(file)
    in_tree = binding["godot_cpp"] is None
    print(f"binding: {binding['godot_cpp'] or 'in-tree'}")
    tally = Tally()
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        project, home = folder / "project", folder / "home"
        home.mkdir()
        make_project(project, library)
        script_tests(tally, godot, project, home, in_tree)
        unload_tests(tally, godot, project, home)
        golden_tests(tally, godot, project, home, update, in_tree)
        generator_cases.run(tally.check, folder)
        godot_cpp_cases.run(tally.check, folder, godot)
    if in_tree:
        refusal_cases.run(tally.check, library)
    else:
        print("left out with a godot-cpp: misuse, refused engines, snippets that must not compile")
    snippet_cases.run(tally.check, binding["includes"], in_tree)
    allowed_name_tests(tally)
    print(f"{tally.passed} passed, {tally.failed} failed")
    return 1 if tally.failed or not tally.passed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
