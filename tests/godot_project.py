#!/usr/bin/env python3
"""Makes a Godot project ready for use from the command line: python3 godot_project.py GODOT PROJECT

The add-on's link, the list of extensions and the import. The list is written before Godot sees the
project: a headless Godot that meets an extension for the first time crashes when it ends.
"""

import os
import shutil
import subprocess
import sys

ADDONS = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "addons")
MANIFEST = os.path.join(ADDONS, "spidar_g", "spidar_g.gdextension")  # written by the build
EXTENSION = "res://addons/spidar_g/spidar_g.gdextension"
COPY_MARK = ".copied_by_spidar_g"
IMPORT_LIMIT_S = 300  # an import takes seconds; a hung Godot must not hold a test for ever


class ProjectError(Exception):
    """The project cannot be made ready; the text says why."""


def link_addons(project):
    """PROJECT/addons: a link to the repository's addons folder. Where links do not exist, a junction (Windows) or a copy."""
    link = os.path.join(project, "addons")
    target = os.path.relpath(ADDONS, project)
    if os.path.islink(link):
        if os.readlink(link) == target:
            return
        os.remove(link)
    elif os.path.isdir(link):
        if os.path.realpath(link) == os.path.realpath(ADDONS):
            return  # a junction
        if not os.path.exists(os.path.join(link, COPY_MARK)):
            raise ProjectError(f"{link} is a folder of its own; move it away, a link belongs there")
        shutil.rmtree(link)
    elif os.path.isfile(link):  # a committed link, checked out as text by a git that makes no links
        os.remove(link)
        hide_from_git(link)
    try:
        os.symlink(target, link, target_is_directory=True)
    except OSError:
        if not make_junction(link):
            copy_addons(link)


def make_junction(link):
    """What Windows gives everybody, while links need a right of their own."""
    if os.name != "nt":
        return False
    command = ["cmd", "/c", "mklink", "/J", os.path.abspath(link), ADDONS]
    return subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False).returncode == 0


def copy_addons(link):
    """The last way: it is made anew each time, and knows itself by a mark."""
    shutil.copytree(ADDONS, link)
    with open(os.path.join(link, COPY_MARK), "w", encoding="utf-8") as file:
        file.write("A copy of the repository's addons folder, made by tests/godot_project.py.\n")


def hide_from_git(link):
    """git would call a committed link changed that is a folder now: in this clone alone, it looks away."""
    folder, name = os.path.split(os.path.abspath(link))
    git = ["git", "-C", folder]
    try:
        subprocess.run([*git, "update-index", "--skip-worktree", name], capture_output=True, check=True)
        exclude = subprocess.run([*git, "rev-parse", "--git-path", "info/exclude"], capture_output=True, check=True, text=True)
        prefix = subprocess.run([*git, "rev-parse", "--show-prefix"], capture_output=True, check=True, text=True)
        with open(os.path.join(folder, exclude.stdout.strip()), "a", encoding="utf-8") as file:
            file.write(f"/{prefix.stdout.strip()}{name}\n")
    except (OSError, subprocess.CalledProcessError):
        pass  # no git, or no clone: nobody asks


def list_extensions(project, extensions=(EXTENSION,)):
    """PROJECT/.godot/extension_list.cfg: what Godot loads at start."""
    path = os.path.join(project, ".godot", "extension_list.cfg")
    text = "\n".join(extensions) + "\n"
    os.makedirs(os.path.dirname(path), exist_ok=True)
    if not os.path.exists(path) or open(path, encoding="utf-8").read() != text:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)


def newest_change(*folders):
    """The latest time of change of any file or folder that an import looks at (unit: ns)."""
    newest = 0
    for root in folders:
        for folder, folders_below, names in os.walk(root):
            folders_below[:] = [name for name in folders_below if name not in (".godot", "bin")]
            paths = [folder] + [os.path.join(folder, name) for name in names]
            newest = max([newest] + [os.lstat(path).st_mtime_ns for path in paths])
    return newest


def import_assets(godot, project):
    """Godot's import, when something changed since the last one."""
    stamp = os.path.join(project, ".godot", "spidar_g_import")
    if os.path.exists(stamp):
        by = open(stamp, encoding="utf-8").read()
        if by == godot and os.lstat(stamp).st_mtime_ns >= newest_change(project, ADDONS):
            return
    command = [godot, "--headless", "--path", project, "--import"]
    try:
        done = subprocess.run(
            command, timeout=IMPORT_LIMIT_S, text=True, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, check=False,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ProjectError(f"import of {project} failed: {error}") from error
    if done.returncode != 0:
        raise ProjectError(f"import of {project} ended with {done.returncode}:\n{done.stdout}")
    with open(stamp, "w", encoding="utf-8") as file:
        file.write(godot)


def prepare_project(project, godot=None):
    """All that a run from the command line needs. Without `godot` there is no import: enough for a
    project with no assets and no class_name. Raises ProjectError."""
    if not os.path.isfile(os.path.join(project, "project.godot")):
        raise ProjectError(f"{project} holds no project.godot")
    if not os.path.isfile(MANIFEST):
        raise ProjectError("addons/spidar_g holds no manifest yet: run ./dev build first")
    link_addons(project)
    list_extensions(project)
    if godot:
        import_assets(godot, project)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__.splitlines()[0])
    try:
        prepare_project(sys.argv[2], sys.argv[1])
    except ProjectError as problem:
        sys.exit(f"godot_project: {problem}")
