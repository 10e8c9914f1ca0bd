"""tools/docs/check_blocks.py: a GDScript block of a page is run by a test or parses."""

import os
import unittest

import repository
import check_blocks

PAGE = "# O\n\n```gdscript\n{}\n```\n"


def complaints(block, tests="extends Node\n"):
    with repository.repository({"docs/how_to/other.md": PAGE.format(block),
                                "tests/godot/project/test_docs.gd": tests}) as folder:
        return check_blocks.complaints(os.environ["GODOT"], folder)


class Blocks(unittest.TestCase):
    def test_what_parses(self):
        for block in ("extends Node3D\nfunc f() -> void:\n    pass", "var x := 1\n\nfunc _ready() -> void:\n    add_child(Node.new())",
                      "device.clear_contacts()   # a comment\nfor i: int in 3:\n    print(i)"):
            self.assertEqual(complaints(block), {"docs/how_to/other.md": []}, block)

    def test_what_does_not(self):
        for block in ("device.no_such_method(", "extends Node3D\nfunc f() -> void:\n    nothing_known()", "a line of prose"):
            found = complaints(block)["docs/how_to/other.md"]
            self.assertEqual([line for line, _ in found], [3], block)

    def test_a_page_that_a_test_runs(self):
        self.assertEqual(complaints("a line of prose", 'const PAGE := "../../docs/how_to/other.md"\n'),
                         {"docs/how_to/other.md": []})
        self.assertEqual(complaints("a line of prose", 'open_page("other.md", "O")\n'), {"docs/how_to/other.md": []})
        self.assertNotEqual(complaints("a line of prose", "# see other.md in a comment\n"), {"docs/how_to/other.md": []})
