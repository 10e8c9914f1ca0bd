"""The class help: gdextension/doc_classes and the comments of addons/spidar_g/nodes, in Godot's XML, as plain records."""

import collections
import glob
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests"))
import godot_project  # noqa: E402

LIBRARY = os.path.join(ROOT, "gdextension", "doc_classes")
SCRIPTS = "res://addons/spidar_g/nodes"
PROJECT = os.path.join(ROOT, "tests", "godot", "project")
LIMIT_S = 120
# How Godot writes a constant that is an object: a script that was loaded, which no user reads about.
OBJECT = "<Object>"

Class = collections.namedtuple("Class", "name inherits brief description items source")
# kind: method, member, signal or constant. type: what a method returns, a member's type, the enumeration of a constant.
# arguments: a list of (name, type, default). default: of a member; the value of a constant.
Item = collections.namedtuple("Item", "kind name type arguments default qualifiers text")


def text_of(element):
    """Godot's indentation removed: that of the first line, from every line."""
    lines = ((element.text or "") if element is not None else "").strip("\n").rstrip().split("\n")
    indent = lines[0][:len(lines[0]) - len(lines[0].lstrip())]
    return "\n".join(line.removeprefix(indent) for line in lines)


def arguments_of(element):
    return [(part.get("name"), part.get("enum") or part.get("type"), part.get("default"))
            for part in element.findall("param")]


def item_of(element):
    kind = element.tag
    described = element if kind in ("member", "constant") else element.find("description")
    returned = element.find("return")
    returned = "" if returned is None else returned.get("enum") or returned.get("type")
    kept = {"method": returned, "signal": "", "constant": element.get("enum") or ""}
    return Item(kind, element.get("name"), kept.get(kind, element.get("enum") or element.get("type") or ""),
                arguments_of(element), element.get("default") or element.get("value") or "",
                element.get("qualifiers") or "", text_of(described))


def is_public(element):
    """Not what begins with an underscore, what a class inherits, and scripts that a script loads."""
    return not (element.get("name").startswith("_") or element.get("overrides") or element.get("value") == OBJECT)


def read_class(path):
    """The class of one XML file."""
    root = ElementTree.parse(path).getroot()
    items = [item_of(element) for kind in ("member", "method", "signal", "constant")
             for element in root.iterfind(f".//{kind}") if is_public(element)]
    return Class(root.get("name"), root.get("inherits"), text_of(root.find("brief_description")),
                 text_of(root.find("description")), items, os.path.relpath(path, ROOT))


def read_folder(folder):
    """The classes of a folder, without scripts that have no class name: Godot names their files by path, with --."""
    paths = sorted(glob.glob(os.path.join(glob.escape(folder), "*.xml")))
    return [read_class(path) for path in paths if "--" not in os.path.basename(path)]


def read_scripts(godot):
    """The classes of addons/spidar_g/nodes: Godot makes XML of their comments."""
    godot_project.prepare_project(PROJECT, godot)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([godot, "--headless", "--path", PROJECT, "--doctool", folder, "--gdscript-docs", SCRIPTS],
                       timeout=LIMIT_S, check=True, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                       stderr=subprocess.STDOUT)
        return [each._replace(source=SCRIPTS.removeprefix("res://")) for each in read_folder(folder)]


def read_all(godot):
    """Every class that a user sees, by name."""
    return sorted(read_folder(LIBRARY) + read_scripts(godot), key=lambda each: each.name)
