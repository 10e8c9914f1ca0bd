#!/usr/bin/env python3
"""The check of the rooms notices what it is there for. Prints "N passed, N failed"."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import check_boundaries  # noqa: E402
from boundaries import rooms  # noqa: E402

SMALL = {
    "gdextension/core/base/types.h": "#pragma once\n",
    "gdextension/core/geometry/frame.h": '#include "core/base/types.h"\n',
    "demo_project/scene/table.gd": "class_name DemoTable\nextends Node3D\n",
    "demo_project/hub/hub.gd": 'extends Node3D\nvar table: DemoTable  # Knob\nconst A := preload("knob.gd")\n',
    "demo_project/hub/knob.gd": 'extends Node3D\nconst B := preload("res://addons/spidar_g/nodes/view.gd")\n',
    "demo_project/hub/hub.tscn": '[ext_resource path="res://scene/table.gd" id="1"]\n',
    "addons/spidar_g/nodes/view.gd": "extends Node3D\n",
}
LIST = """# rooms
core/base: types
core/geometry: frame -> core/base
demo_project/scene: table
demo_project/hub: menu -> demo_project/scene, addons/spidar_g/nodes
addons/spidar_g/nodes: nodes
"""


def texts(sources, text):
    return [complaint[2] for complaint in rooms.complaints(sources, rooms.Rules(text))]


class Small(unittest.TestCase):
    def test_what_is_listed_is_allowed(self):
        self.assertEqual(texts(SMALL, LIST), [])

    def test_an_include_against_the_arrow(self):
        sources = {**SMALL, "gdextension/core/base/types.h": '#include "core/geometry/frame.h"\n'}
        self.assertIn("core/base may not use core/geometry", texts(sources, LIST))

    def test_a_class_name_of_another_room(self):
        sources = {**SMALL, "demo_project/scene/lamp.gd": "var hub: DemoHub\n",
                   "demo_project/hub/hub.gd": SMALL["demo_project/hub/hub.gd"] + "class_name DemoHub\n"}
        self.assertIn("demo_project/scene may not use demo_project/hub", texts(sources, LIST))

    def test_a_preload_and_a_scene_of_another_room(self):
        for path, line in (("demo_project/scene/a.gd", 'const X := preload("../hub/knob.gd")\n'),
                           ("demo_project/scene/a.gd", 'var x: Variant = load("res://hub/hub.tscn")\n'),
                           ("demo_project/scene/a.tscn", '[ext_resource path="res://hub/hub.tscn" id="1"]\n')):
            self.assertIn("demo_project/scene may not use demo_project/hub", texts({**SMALL, path: line}, LIST))

    def test_the_add_on_may_not_use_the_demo(self):
        sources = {**SMALL, "addons/spidar_g/nodes/view.gd": 'const X := preload("res://scene/table.gd")\n'}
        self.assertIn("addons/spidar_g/nodes may not use demo_project/scene", texts(sources, LIST))

    def test_names_in_comments_and_strings_are_no_use(self):
        sources = {**SMALL, "addons/spidar_g/nodes/view.gd": '# DemoTable\nvar text := "DemoTable"\n'}
        self.assertEqual(texts(sources, LIST), [])

    def test_a_circle(self):
        circle = LIST.replace("core/base: types", "core/base: types -> core/geometry")
        self.assertTrue(any("in a circle" in text for text in texts(SMALL, circle)))

    def test_an_arrow_that_nothing_uses(self):
        unused = LIST.replace("core/base: types", "core/base: types -> demo_project/scene")
        self.assertIn("core/base -> demo_project/scene: nothing uses it", texts(SMALL, unused))

    def test_a_room_that_is_not_listed_or_not_there(self):
        self.assertIn("the room core/new is missing",
                      texts({**SMALL, "gdextension/core/new/a.h": "\n"}, LIST))
        self.assertIn("core/old has no files", texts(SMALL, LIST + "core/old: nothing\n"))

    def test_a_crowded_room(self):
        crowd = {f"gdextension/core/base/part_{i}.h": "\n" for i in range(rooms.MOST_FILES)}
        self.assertIn(f"core/base has {rooms.MOST_FILES + 1} files, the limit is {rooms.MOST_FILES}",
                      texts({**SMALL, **crowd}, LIST))

    def test_a_line_that_says_nothing(self):
        self.assertTrue(any("is no `room:" in text for text in texts(SMALL, LIST + "core / what\n")))


class Whole(unittest.TestCase):
    """Every arrow of the real list, turned round, is noticed."""

    def test_each_arrow_reversed(self):
        sources = check_boundaries.room_sources(check_boundaries.tracked_files())
        with open(os.path.join(check_boundaries.ROOT, rooms.LIST), encoding="utf-8") as file:
            text = file.read()
        rules = rooms.Rules(text)
        uses = list(rooms.arrows(sources))
        pairs = [(room, target) for room, used in rules.uses.items() for target in used]
        self.assertGreater(len(pairs), 50)
        for room, target in pairs:
            rules = rooms.Rules(text)
            rules.uses[room].remove(target)
            rules.uses[target].append(room)
            found = [complaint[2] for complaint in rooms.complaints(sources, rules, uses)]
            self.assertIn(f"{room} may not use {target}", found)
            self.assertIn(f"{target} -> {room}: nothing uses it", found)


def main():
    result = unittest.TextTestRunner(stream=sys.stdout).run(
        unittest.defaultTestLoader.loadTestsFromModule(sys.modules[__name__]))
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    return 1 if failed or not result.testsRun else 0


if __name__ == "__main__":
    sys.exit(main())
