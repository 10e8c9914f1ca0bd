"""The rooms of the sources and the arrows between them, against the list in docs/why/rooms.txt.

A room is a folder. C++ uses another room by #include "room/header.h"; GDScript and scenes use one by a path (preload,
load, extends, ext_resource) or by a class_name that the other room declares.
"""

import collections
import os
import re

LIST = "docs/why/rooms.txt"
ROOTS = {  # where the sources lie -> what their rooms' names begin with
    "gdextension/core": "core", "gdextension/device": "device", "gdextension/godot": "godot",
    "addons/spidar_g": "addons/spidar_g", "demo_project": "demo_project",
}
SUFFIXES = (".cpp", ".h", ".gd", ".tscn")
SCENES_ALONE = ("objects", "parts", "shapes")  # folders of scenes: they belong to the room above
ONE_ROOM = ("addons/spidar_g/examples",)  # with all folders below: one example a folder, none uses another
MOST_FILES = 18  # in one room, a source and its header counted as one: more are not found by eye

INCLUDE = re.compile(r'\s*#\s*include\s+"((?:core|device|godot)/[^"]+)"')
RESOURCE = re.compile(r'"(res://[^"]+\.(?:gd|tscn|tres))"')
RELATIVE = re.compile(r'\b(?:preload|load|extends)\b\s*\(?\s*"([\w./]+\.(?:gd|tscn))"')
CLASS_NAME = re.compile(r"^class_name\s+(\w+)", re.MULTILINE)
ROOM_LINE = re.compile(r"^(?P<room>[\w/]+): (?P<what>[^>]+?)(?: -> (?P<uses>.+))?$")

Arrow = collections.namedtuple("Arrow", "room target path line")


class Rules:
    """docs/why/rooms.txt: `room: what is in it -> rooms that it may use`."""

    def __init__(self, text):
        self.what = {}
        self.uses = {}
        self.faults = []  # (line number, text)
        for number, line in enumerate(text.splitlines(), 1):
            if not line.strip() or line.startswith("#"):
                continue
            found = ROOM_LINE.match(line)
            if not found:
                self.faults.append((number, f"is no `room: what is in it -> rooms`: {line}"))
                continue
            room = found["room"]
            self.what[room] = found["what"]
            self.uses[room] = [name.strip() for name in (found["uses"] or "").split(",") if name.strip()]
        for room, used in self.uses.items():
            for target in used:
                if target not in self.what:
                    self.faults.append((1, f"{room} -> {target}: there is no room {target}"))

    def cycle(self):
        """A way from a room back to itself, or nothing."""
        done = set()

        def walk(room, way):
            if room in way:
                return way[way.index(room):] + [room]
            if room in done:
                return None
            for target in self.uses.get(room, ()):
                found = walk(target, way + [room])
                if found:
                    return found
            done.add(room)
            return None

        for room in self.what:
            found = walk(room, [])
            if found:
                return found
        return None


def room_of(path):
    """The room that a file lies in; None for a file that lies in none."""
    for root, name in ROOTS.items():
        if path.startswith(root + "/") and path.endswith(SUFFIXES):
            folder = os.path.dirname(path)
            if path.endswith(".tscn") and os.path.basename(folder) in SCENES_ALONE:
                folder = os.path.dirname(folder)
            room = os.path.join(name, folder[len(root) + 1:]).rstrip("/")
            return next((whole for whole in ONE_ROOM if (room + "/").startswith(whole + "/")), room)
    return None


def project_path(path, resource):
    """The file in this repository behind a res:// path that a file of the demo or the add-on names."""
    inside = resource[len("res://"):]
    return inside if inside.startswith("addons/") else "demo_project/" + inside


def classes_of(sources):
    """The room of each class_name."""
    found = {}
    for path, text in sources.items():
        if path.endswith(".gd"):
            for name in CLASS_NAME.findall(text):
                found[name] = room_of(path)
    return found


def without_comments(line):
    """A line of GDScript without its comment and, for class names, without its strings."""
    return re.sub(r'"[^"]*"', '""', line).split("#")[0]


def targets_of_line(path, line, classes):
    """The rooms that a line uses."""
    if path.endswith((".cpp", ".h")):
        found = INCLUDE.match(line)
        if found:
            yield os.path.dirname(found.group(1))
        return
    for resource in RESOURCE.findall(line):
        yield room_of(project_path(path, resource))
    if path.endswith(".gd"):
        for relative in RELATIVE.findall(line):
            yield room_of(os.path.normpath(os.path.join(os.path.dirname(path), relative)))
        for word in re.findall(r"\b[A-Z]\w+", without_comments(line)):
            yield classes.get(word)


def arrows(sources):
    """Every use of another room. sources: {path: text} of all files of all rooms."""
    classes = classes_of(sources)
    for path, text in sources.items():
        room = room_of(path)
        for number, line in enumerate(text.splitlines(), 1):
            for target in targets_of_line(path, line, classes):
                if target is not None and target != room:
                    yield Arrow(room, target, path, number)


def sizes(sources):
    """How many files each room has; a source and its header count as one."""
    stems = {os.path.splitext(path)[0] for path in sources if not path.endswith(".tscn")}
    counts = collections.Counter(room_of(stem + ".h") for stem in stems)
    for path in sources:
        counts.setdefault(room_of(path), 0)
    return counts


def complaints(sources, rules, uses=None):
    """(path, line, text) of everything that the list does not allow, and of what in the list is not so. uses: the
    arrows of these sources, where they are known already."""
    for number, text in rules.faults:
        yield LIST, number, text
    cycle = rules.cycle()
    if cycle:
        yield LIST, 1, f"the rooms use each other in a circle: {' -> '.join(cycle)}"
    used = set()
    for arrow in arrows(sources) if uses is None else uses:
        used.add((arrow.room, arrow.target))
        if arrow.target not in rules.uses.get(arrow.room, ()):
            yield arrow.path, arrow.line, f"{arrow.room} may not use {arrow.target}"
    counts = sizes(sources)
    for room, count in sorted(counts.items()):
        if room not in rules.what:
            yield LIST, 1, f"the room {room} is missing"
        if count > MOST_FILES:
            yield LIST, 1, f"{room} has {count} files, the limit is {MOST_FILES}"
    for room, targets in rules.uses.items():
        if room not in counts:
            yield LIST, 1, f"{room} has no files"
        for target in targets:
            if (room, target) not in used:
                yield LIST, 1, f"{room} -> {target}: nothing uses it"


def table(sources, rules):
    """The list for people: each room with its number of files and the rooms that it may use."""
    counts = sizes(sources)
    width = max(len(room) for room in rules.what)
    for room, what in rules.what.items():
        yield f"{room:{width}}  {counts.get(room, 0):3}  {what}"
        if rules.uses[room]:
            yield f"{'':{width}}       -> {', '.join(rules.uses[room])}"
