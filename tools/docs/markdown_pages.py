"""The Markdown of a repository as the checks and the site need it: headings, links, pictures and code blocks.

Only what git tracks or would add is a page; hidden folders (.github) hold forms, not pages.
"""

import collections
import os
import re
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

FENCE = re.compile(r"^\s*(`{3,}|~{3,})\s*([^`]*)$")
HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*#*$")
# The text of a link may hold a picture, which has brackets of its own.
TEXT = r"(?:!\[[^\]]*\]\([^)]*\)|[^\[\]])*"
LINK = re.compile(rf"(?<!!)\[({TEXT})\]\(\s*<?([^()\s>]*(?:\([^()\s]*\)[^()\s>]*)*)>?(?:\s+[\"'][^)]*)?\)")
PICTURE = re.compile(r"!\[([^\]]*)\]\(\s*<?([^()\s>]*)>?(?:\s+[\"'][^)]*)?\)")
REFERENCE = re.compile(r"^\s{0,3}\[[^\]^]+\]:\s+<?(\S+?)>?(?:\s|$)")
HTML_LINK = re.compile(r"<a\s[^>]*href=\"([^\"]*)\"")
HTML_PICTURE = re.compile(r"<img\s[^>]*>")
HTML_ANCHOR = re.compile(r"<\w+\s[^>]*(?:id|name)=\"([^\"]+)\"")
CODE_SPAN = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)")

Link = collections.namedtuple("Link", "line target")
Picture = collections.namedtuple("Picture", "line target text")
Block = collections.namedtuple("Block", "line language text")  # the line of its opening fence


def tracked_files(root=ROOT):
    """Paths, relative to the root, of the files that are committed or that git would add."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    done = subprocess.run(command, cwd=root, check=True, capture_output=True, text=True)
    return sorted({path for path in done.stdout.split("\0") if path and os.path.isfile(os.path.join(root, path))})


def page_paths(files):
    return [path for path in files if path.endswith(".md") and not path.startswith(".")]


def split_code(text):
    """(lines with every fenced block blanked, the blocks). Line numbers stay those of the text."""
    lines, blocks = [], []
    fence = language = None
    start, inside = 0, []
    for number, line in enumerate(text.splitlines(), 1):
        found = FENCE.match(line)
        if fence is None and found:
            fence, language, start, inside = found.group(1), found.group(2).strip(), number, []
        elif fence is not None and found and not found.group(2) and found.group(1).startswith(fence):
            blocks.append(Block(start, language, "\n".join(inside)))
            fence = None
        elif fence is not None:
            inside.append(line)
        else:
            lines.append(line)
            continue
        lines.append("")
    if fence is not None:
        blocks.append(Block(start, language, "\n".join(inside)))
    return lines, blocks


def slug(heading):
    """The anchor that forges give a heading."""
    text = LINK.sub(r"\1", heading).replace("`", "")
    text = re.sub(r"(?<!\w)[*_]+|[*_]+(?!\w)|<[^>]*>", "", text)
    return re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", "-")


class Page:
    """One Markdown file."""

    def __init__(self, path, text):
        self.path = path
        self.text = text
        self.lines, self.blocks = split_code(text)
        self.spans = []  # (line, text) of code inside lines
        self.links, self.pictures, self.anchors = [], [], set()
        slugs = collections.Counter()
        for number, line in enumerate(self.lines, 1):
            heading = HEADING.match(line)
            if heading:
                name = slug(heading.group(2))
                self.anchors.add(f"{name}-{slugs[name]}" if slugs[name] else name)
                slugs[name] += 1
            self.spans += [(number, found.group(2)) for found in CODE_SPAN.finditer(line)]
            self._read_line(number, CODE_SPAN.sub("code", line))

    def _read_line(self, number, line):
        self.anchors.update(HTML_ANCHOR.findall(line))
        self.links += [Link(number, found.group(2)) for found in LINK.finditer(line)]
        self.links += [Link(number, target) for target in HTML_LINK.findall(line)]
        self.links += [Link(number, target) for target in REFERENCE.findall(line)]
        self.pictures += [Picture(number, target, text) for text, target in PICTURE.findall(line)]
        for tag in HTML_PICTURE.findall(line):
            parts = dict(re.findall(r"(\w+)=\"([^\"]*)\"", tag))
            self.pictures.append(Picture(number, parts.get("src", ""), parts.get("alt", "")))

    def target_path(self, target):
        """The path, relative to the root, that a relative link names; the page itself for #anchor."""
        file = target.split("#")[0]
        return os.path.normpath(os.path.join(os.path.dirname(self.path), file)) if file else self.path


def is_outside(target):
    """Whether a link leads to another host."""
    return re.match(r"[a-z][a-z0-9+.-]*:", target) is not None


def read_pages(root=ROOT, files=None):
    """{path: Page} of every page."""
    pages = {}
    for path in page_paths(tracked_files(root) if files is None else files):
        with open(os.path.join(root, path), encoding="utf-8") as file:
            pages[path] = Page(path, file.read())
    return pages
