#!/usr/bin/env python3
"""The built site: check_site.py FOLDER

Every page of docs and every class has its page, the search has its words, and no page loads anything from another host.
The last line is "N passed, N failed".
"""

import glob
import os
import re
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tools", "docs"))
import markdown_pages  # noqa: E402

# What a browser loads by itself; links that a reader follows are none of it.
LOADED = re.compile(r"<(?:script|img|source|iframe|video)\b[^>]*\bsrc=\"([^\"]*)\"|<link\b[^>]*\bhref=\"([^\"]*)\"")
STYLED = re.compile(r"url\(\s*['\"]?((?:https?:)?//[^)'\"]*)")

passed = failed = 0


def check(good, what):
    global passed, failed
    passed, failed = passed + bool(good), failed + (not good)
    print("ok  " if good else "FAIL", what)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def main(site):
    pages = [path for path in markdown_pages.read_pages() if path.startswith("docs/") and not path.startswith("docs/pictures/")]
    classes = [os.path.basename(path)[:-4] for path in glob.glob(os.path.join(ROOT, "gdextension", "doc_classes", "*.xml"))]
    wanted = ["index.html", "search.html"] + [path[:-3] + ".html" for path in pages]
    wanted += [f"docs/reference/classes/{name.lower()}.html" for name in [*classes, "index", "SpidarGGrip"]]
    for path in wanted:
        check(os.path.isfile(os.path.join(site, path)), f"the site has {path}")
    words = read(os.path.join(site, "searchindex.js"))
    check(words.startswith("Search.setIndex(") and "pretens" in words, "the search knows the word pretension")
    html = glob.glob(os.path.join(glob.escape(site), "**", "*.html"), recursive=True)
    outside, missing = [], []
    for path in html:
        for found in LOADED.findall(read(path)):
            target = "".join(found).split("?")[0].split("#")[0]
            if re.match(r"(https?:)?//", target):
                outside.append(target)
            elif target and not target.startswith("data:") and not os.path.exists(os.path.join(os.path.dirname(path), target)):
                missing.append(f"{os.path.relpath(path, site)}: {target}")
    for path in glob.glob(os.path.join(glob.escape(site), "_static", "**", "*.css"), recursive=True):
        outside += STYLED.findall(read(path))
    check(html and not outside, f"{len(html)} pages load nothing from another host: {outside[:3]}")
    check(html and not missing, f"what they load is there: {missing[:3]}")
    home = read(os.path.join(site, "index.html"))
    check("theme-toggle" in home, "a reader can choose light or dark")
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
