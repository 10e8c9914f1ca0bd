"""tools/docs/bbcode.py and class_pages.py: Godot's help as Markdown."""

import unittest

import repository  # noqa: F401 (the path)
import bbcode
import class_pages
from class_help import Class, Item

THING = Class("SpidarGThing", "Node3D", "A thing.", "It uses [SpidarGThing] and [method open].", [
    Item("method", "open", "int", [("path", "String", '""')], "", "const", "Opens [param path]."),
    Item("member", "size_max", "float[]", [], "1.0", "", "Its size, see [constant BIG] and [enum Kind]."),
    Item("constant", "BIG", "SpidarGThing.Kind", [], "3", "", "A | B."),
    Item("constant", "ALONE", "", [], "4", "", "Alone."),
], "x")
LINKER = class_pages.Linker([THING])


def markdown(text):
    return bbcode.to_markdown(text, LINKER.inside("SpidarGThing"))


class Texts(unittest.TestCase):
    def test_marks(self):
        for text, wanted in (
                ("[b]a[/b] [i]b[/i] [code]x[0] * y[/code]", "**a** *b* `x[0] * y`"),
                ("[param size_max]", "`size_max`"),
                ("a_b * c < d", "a\\_b \\* c \\< d"),
                ("one [br][br]two\nthree", "one\n\ntwo\n\nthree"),
                ("Keys:\n- [code]a[/code]: one.\n- b: two.\n- c: three.", "Keys:\n\n- `a`: one.\n- b: two.\n- c: three."),
                ("[url=mailto:a@localhost]paper[/url]", "[paper](mailto:a@localhost)")):
            self.assertEqual(markdown(text), wanted)

    def test_blocks(self):
        self.assertEqual(markdown("See:\n[codeblock]\n\tif a:\n\t\tb[0] = 1\n[/codeblock]\nEnd."),
                         "See:\n\n```gdscript\nif a:\n\tb[0] = 1\n```\n\nEnd.")
        self.assertIn("```text\nA\n└─ B\n```", markdown("[codeblock]\nA\n└─ B\n[/codeblock]"))

    def test_references(self):
        self.assertEqual(markdown("[method open]"), "[`open()`](#help-spidargthing-open)")
        self.assertEqual(markdown("[constant SpidarGThing.BIG]"), "[`BIG`](#help-spidargthing-enum-kind)")
        self.assertEqual(markdown("[enum Kind]"), "[`Kind`](#help-spidargthing-enum-kind)")
        self.assertIn("class_node3d.html", markdown("[method Node3D.rotate]"))
        self.assertIn("class_int.html", markdown("[int]"))
        self.assertEqual(markdown("[member gone]"), "`gone`")


class Pages(unittest.TestCase):
    def test_page(self):
        page = class_pages.page(THING, LINKER)
        for part in ("# SpidarGThing\n", "open(path: String = \"\") -> int const", "size_max: float[] = 1.0",
                     "### enum Kind", "| `BIG` | `3` | A \\| B. |", "| `ALONE` | `4` | Alone. |",
                     "Type: `Array` of [`float`]"):
            self.assertIn(part, page)

    def test_index(self):
        self.assertIn("\nspidargthing\n", class_pages.index([THING], LINKER))
