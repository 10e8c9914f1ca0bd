"""tools/docs/check_pages.py: every kind of fault of a page is found, and at its line."""

import unittest

import repository
import check_pages
import markdown_pages


def complaints(changed=None):
    with repository.repository(changed) as folder:
        found = check_pages.complaints(folder)
    return [f"{path}:{line}: {text}" for path, problems in found.items() for line, text in problems]


class Pages(unittest.TestCase):
    def expect(self, text, *wanted):
        found = complaints({"docs/how_to/other.md": text})
        self.assertEqual(len(found), len(wanted), found)
        for complaint, part in zip(found, wanted):
            self.assertIn(part, complaint)

    def test_pages_in_order(self):
        self.assertEqual(complaints(), [])

    def test_missing_file(self):
        self.expect("# Other\n[x](gone.md)\n", "docs/how_to/other.md:2: the link gone.md leads to no file")

    def test_missing_anchor(self):
        self.expect("# Other\n[x](../start/page.md#third-part)\n", "has no heading #third-part")
        self.expect("# Other\n[x](#another)\n", "has no heading #another")
        self.expect("# Other\n[x](#other) [y](../start/page.md#second-part)\n")

    def test_links_of_other_forms(self):
        self.expect("# O\n[x]: gone.md\n", ":2: the link gone.md")
        self.expect("# O\n<a href=\"gone.md\">x</a>\n", ":2: the link gone.md")
        self.expect("# O\n[![View](../pictures/view.png)](gone.md)\n", ":2: the link gone.md")
        self.expect("# O\n[x](/docs/start/page.md)\n", "is not relative")
        self.expect("# O\n[x](mailto:a@localhost) [folder](../start) [named](../start/page.md \"a title\")\n")

    def test_links_in_code_are_none(self):
        self.expect("# O\n`[x](gone.md)`\n```text\n[x](gone.md)\n```\n")

    def test_ignored_file(self):
        self.assertIn("leads to no file", complaints({
            ".gitignore": "/build/\n", "build/out.txt": "x", "docs/how_to/other.md": "# O\n[x](../../build/out.txt)\n"})[0])

    def test_missing_picture(self):
        self.expect("# O\n![View](../pictures/gone.png)\n", ":2: the picture ../pictures/gone.png is missing")
        self.expect("# O\n<img src=\"gone.png\" alt=\"x\">\n", "gone.png is missing")

    def test_alternative_text(self):
        self.expect("# O\n![](../pictures/view.png)\n", ":2: the picture ../pictures/view.png has no alternative text")
        self.expect("# O\n<img src=\"../pictures/view.png\">\n", "has no alternative text")

    def test_unused_picture(self):
        self.assertEqual(complaints({"docs/pictures/deep/left.png": "x"}),
                         ["docs/pictures/deep/left.png:1: no page uses this picture"])

    def test_language(self):
        self.expect("# O\n\n```\nx\n```\n", ":3: the code block names no language")
        self.expect("# O\n\n* item\n\n  ```text\n  x\n  ```\n")

    def test_commands(self):
        self.expect("# O\n```sh\n./dev test\n./dev frobnicate\n```\n", "./dev has no command frobnicate")
        self.expect("# O\n```sh\n./dev stage frobnicate\n```\n", "./dev has no stage frobnicate")
        self.expect("# O\nRun `./dev frobnicate`.\n", ":2: ./dev has no command frobnicate")
        self.assertEqual(complaints({"CHANGELOG.md": "# Changes\n`./dev frobnicate` is gone.\n"}), [])


class Anchors(unittest.TestCase):
    def test_slugs(self):
        for heading, wanted in (("Second part", "second-part"), ("`a_b()` and *c*", "a_b-and-c"),
                                ("A, b: c & d", "a-b-c--d"), ("With [a link](x.md)", "with-a-link")):
            self.assertEqual(markdown_pages.slug(heading), wanted)

    def test_repeated_heading(self):
        page = markdown_pages.Page("a.md", "# A\n## Part\n## Part\n")
        self.assertEqual(page.anchors, {"a", "part", "part-1"})
