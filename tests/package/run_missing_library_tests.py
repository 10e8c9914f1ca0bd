#!/usr/bin/env python3
"""A game where the add-on has no library: run_missing_library_tests.py GODOT

Its project with the library removed, its pack beside the library and without it, what Godot and the plugin say in the
editor, and the demo. The last line is "N passed, N failed".
"""

import os
import re
import shutil
import sys

import exported
from exported import ROOT, check, godot_project

HERE = os.path.dirname(os.path.abspath(__file__))
OUT = os.path.join(ROOT, "build", "missing_library")
ADDON = os.path.join("addons", "spidar_g")
SENTENCE = re.compile(r"^WARNING: The SPIDAR-G add-on has no library for this system \(\w+ on \w+\): no device is read", re.M)
EDITOR_SENTENCE = re.compile(r"^WARNING: The SPIDAR-G add-on has no library for this system \(\w+ on \w+\): its nodes", re.M)
# What Godot itself prints of a library that is not there, and of a scene that was not opened.
GODOTS_OWN = re.compile(r"FileAccess::exists\(path\)|dynamic library not found|Error loading extension|"
                        r"No GDExtension library found|library found for GDExtension|Can't open GDExtension|get_system_processor|"
                        r"completed with warnings")


def game(godot, name):
    """The game of tests/package/missing_library with a copy of the add-on of its own."""
    project = os.path.join(OUT, name)
    exported.copy_project(os.path.join("tests", "package", "missing_library"), project)
    shutil.copytree(os.path.join(ROOT, ADDON), os.path.join(project, ADDON))
    godot_project.list_extensions(project)
    return project


def errors_of(output):
    return [line for line in exported.errors_of(output) if not GODOTS_OWN.search(line) and not SENTENCE.match(line)
            and not EDITOR_SENTENCE.match(line)]


def play(command, folder, name, library):
    code, output = exported.run([*command, "--headless", "--fixed-fps", "60"], folder)
    said = len(SENTENCE.findall(output))
    check(code == 0 and "PLAYED 60 frames, the library is " + ("there" if library else "missing") in output,
          f"{name}: the game plays (exit code {code})")
    check(said == (0 if library else 1), f"{name}: says {said} times that there is no library")
    check(not errors_of(output), f"{name}: nothing else is wrong: {errors_of(output)[:3]}")
    if code != 0 or errors_of(output):
        print(output[-3000:])


def editor(godot, project):
    """Output of the project opened in the editor and closed."""
    code, output = exported.run([godot, "--headless", "--editor", "--quit-after", "30", "--path", project], project)
    check(code == 0, f"the project opens in the editor and closes (exit code {code})")
    return output


def check_project(godot):
    project = game(godot, "project")
    godot_project.import_assets(godot, project)
    play([godot, "--path", project], project, "project with the library", True)
    shutil.rmtree(os.path.join(project, ADDON, "bin"))
    output = editor(godot, project)
    check(len(EDITOR_SENTENCE.findall(output)) == 1, "the plugin says that there is no library")
    with open(os.path.join(project, "project.godot"), encoding="utf-8") as file:
        check("spidar_g/plugin.cfg" in file.read(), "the plugin stays enabled")
    os.remove(os.path.join(project, ADDON, "stand_in", ".gdignore"))
    output = editor(godot, project)
    check(not errors_of(output), f"with the stand-ins shown the editor has no other complaint: {errors_of(output)[:3]}")
    play([godot, "--path", project], project, "project without the library", False)


def pack_of(godot, project, name):
    """The project's pack, alone in a folder; the project is gone."""
    godot_project.import_assets(godot, project)
    list_file = os.path.join(project, ".godot", "global_script_class_cache.cfg")
    with open(list_file, encoding="utf-8") as file:
        before = file.read()
    pack = os.path.join(OUT, name, "game.pck")
    exported.export(godot, project, "pack", pack, GODOTS_OWN)
    with open(list_file, encoding="utf-8") as file:
        check(file.read() == before, f"{name}: the export leaves the project's list of classes as it was")
    shutil.rmtree(project)
    return pack


def check_pack(godot):
    """For a system that has a library, and for one that has none."""
    pack = pack_of(godot, game(godot, "with"), "pack_with")
    folder = os.path.dirname(pack)
    shutil.copytree(os.path.join(ROOT, ADDON, "bin"), os.path.join(folder, ADDON, "bin"))
    play([godot, "--main-pack", pack], folder, "pack with the library", True)
    # The editor, which is a debug program, has its library; what it exports, for release, has none.
    pack = pack_of(godot, without_library(godot, "without", "linux.release"), "pack_without")
    play([godot, "--main-pack", pack], os.path.dirname(pack), "pack without the library", False)


def without_library(godot, name, system):
    """The game with a manifest that names no library for this system: as for macOS, which there is none for."""
    project = game(godot, name)
    manifest = os.path.join(project, ADDON, "spidar_g.gdextension")
    with open(manifest, encoding="utf-8") as file:
        text = file.read()
    check("macos" not in text, "the manifest names no library for macOS")
    with open(manifest, "w", encoding="utf-8") as file:
        file.write("".join(line for line in text.splitlines(True) if not line.startswith(system)))
    return project


def check_other_systems(godot):
    project = without_library(godot, "other_system", "linux.")
    output = exported.run([godot, "--headless", "--path", project, "--quit"], project)[1]
    told = re.search(r"^.*No GDExtension library found for current OS and architecture.*$", output, re.M)
    check(told, f"Godot says so: {told[0].strip() if told else output[-500:]}")


def check_demo(godot):
    project = os.path.join(OUT, "demo")
    exported.copy_project("demo_project", project)
    shutil.copytree(os.path.join(ROOT, ADDON), os.path.join(project, ADDON), ignore=shutil.ignore_patterns("bin"))
    godot_project.list_extensions(project)
    code, output = exported.run([godot, "--headless", "--path", project], project)
    check(code == 2 and output.count("The SPIDAR-G add-on is not loaded") == 1,
          f"the demo says what is missing and ends (exit code {code})")


def main(godot):
    shutil.rmtree(OUT, ignore_errors=True)
    check_project(godot)
    check_pack(godot)
    check_other_systems(godot)
    check_demo(godot)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(os.path.abspath(sys.argv[1]))
    sys.exit(exported.end())
