"""What a Godot project of this repository needs before its first run: the add-on, and Godot told of it."""

import os

REPOSITORY = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
EXTENSION = "res://addons/spidar_g/spidar_g.gdextension"


def prepare_project(project):
    """Links the add-on into `project` and lists the extension, so that it loads without an import first."""
    link = os.path.join(project, "addons")
    if not os.path.exists(link):
        if os.path.islink(link):
            os.unlink(link)
        os.symlink(os.path.relpath(os.path.join(REPOSITORY, "addons"), project), link)
    cache = os.path.join(project, ".godot")
    os.makedirs(cache, exist_ok=True)
    listing = os.path.join(cache, "extension_list.cfg")
    if not os.path.exists(listing):
        with open(listing, "w", encoding="utf-8") as file:
            file.write(EXTENSION + "\n")
