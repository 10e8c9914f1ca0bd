#!/usr/bin/env python3
"""Makes the pictures of docs/start/first_scene.md anew: make_first_scene_pictures.py GODOT. Needs a display (xvfb-run -a).

The first picture shows a dialog of the editor; the others show the scene, built from the page's own tables.
"""

import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
sys.path.insert(0, os.path.join(os.path.dirname(HERE), "editor"))
import run_view_tests as editor  # noqa: E402
from godot_project import prepare_project  # noqa: E402

PROJECT = os.path.join(HERE, "project")
PICTURES = os.path.join(os.path.dirname(os.path.dirname(HERE)), "docs", "pictures", "first_scene")
TIME_LIMIT_S = 600


def main(godot):
    os.makedirs(PICTURES, exist_ok=True)
    editor.copy_project()
    prepare_project(editor.PROJECT, godot)
    output, code = editor.edit(godot, "settings_dialog", os.path.join(PICTURES, "step_01.png"))
    if code != 0:
        sys.exit(f"the editor ended with {code}:\n{output[-3000:]}")
    prepare_project(PROJECT, godot)
    command = [godot, *editor.DISPLAYED, "--path", PROJECT, "--fixed-fps", "60", "--resolution", "960x540",
               "-s", "res://first_scene_pictures.gd", "--", PICTURES]
    subprocess.run(command, timeout=TIME_LIMIT_S, stdin=subprocess.DEVNULL, check=True)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
