#!/usr/bin/env python3
"""The demo as a shipped game: run_pack_tests.py GODOT

Exports a pack (--export-pack), puts it into an empty folder with nothing but the extension's library beside it, and lets
it play a task by script. The last line is "N passed, N failed".
"""

import os
import shutil
import sys

import exported
from exported import ROOT, check, godot_project

OUT = os.path.join(ROOT, "build", "pack")
LIBRARIES = os.path.join("addons", "spidar_g", "bin")


def main(godot):
    project = os.path.join(OUT, "demo")
    shutil.rmtree(OUT, ignore_errors=True)
    exported.copy_project("demo_project", project)
    godot_project.prepare_project(project, godot)
    game = os.path.join(OUT, "game")
    pack = os.path.join(game, "demo.pck")
    exported.export(godot, project, "pack", pack)
    if not os.path.exists(pack):
        return
    # The project is out of reach from here on.
    shutil.rmtree(project)
    shutil.copytree(os.path.join(ROOT, LIBRARIES), os.path.join(game, LIBRARIES))
    exported.check_play([godot, "--main-pack", pack], game, "pack")
    # What the pack must not need: the add-on's library is the only file of ours outside it.
    outside = [name for _, _, names in os.walk(game) for name in names if name.endswith((".gd", ".tscn", ".svg"))]
    check(not outside, f"nothing but the library is beside the pack: {outside[:3]}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(os.path.abspath(sys.argv[1]))
    sys.exit(exported.end())
