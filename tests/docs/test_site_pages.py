"""tools/docs/build_site.py: which page goes where, and how links are changed."""

import unittest

import repository  # noqa: F401 (the path)
import build_site
from markdown_pages import Page

TEXTS = {
    "README.md": "# Home\n[b](docs/start/b.md) [inner](inner)\n",
    "inner/README.md": "# Inner\n",
    "docs/start/a.md": "# A\n[up](../../README.md#home) [in](../../inner) [src](../../x.py) [folder](../../src) `[x](gone)`\n"
                       "```text\n[up](../../README.md)\n```\n![P](../p.png)\n",
    "docs/start/b.md": "# B\n",
    "docs/why/c.md": "# C\n",
    "docs/extra/d.md": "# D\n",
}
PAGES = {path: Page(path, text) for path, text in TEXTS.items()}


class Site(unittest.TestCase):
    def test_navigation_comes_from_the_folders(self):
        text = build_site.navigation(PAGES)
        captions = [line.split(": ")[1] for line in text.splitlines() if line.startswith(":caption:")]
        self.assertEqual(captions, ["Start", "Reference", "Why", "Extra", "Project"])
        self.assertIn("\ndocs/reference/classes/index\n", text)
        # The home page names b first.
        self.assertLess(text.index("docs/start/b"), text.index("docs/start/a"))
        self.assertIn("\ninner/README\n", text)

    def test_links(self):
        text, needed = build_site.rewritten(PAGES["docs/start/a.md"], PAGES, {*PAGES, "x.py", "docs/p.png", "src/y.h"})
        self.assertEqual(text.splitlines()[1],
                         "[up](../../index.md#home) [in](../../inner/README.md) [src](../../x.py) folder `[x](gone)`")
        self.assertEqual(text.splitlines()[3], "[up](../../README.md)")
        self.assertEqual(needed, {"x.py", "docs/p.png"})
