"""Godot's markup of help texts as Markdown."""

import re

# What stays as it is: blocks of code, code in a line.
BLOCK = re.compile(r"[ \t]*\[(codeblock|gdscript|csharp)\b([^\]]*)\]\n?(.*?)\n?[ \t]*\[/\1\][ \t]*", re.S)
CODE = re.compile(r"\[(code|kbd)(?: [^\]]*)?\](.*?)\[/\1\]", re.S)
REFERENCE = re.compile(r"\[(method|member|signal|constant|enum|annotation|theme_item)\s+([^\]]+)\]")
PARAMETER = re.compile(r"\[param\s+([^\]]+)\]")
URL = re.compile(r"\[url=([^\]]+)\](.*?)\[/url\]", re.S)
CLASS = re.compile(r"\[(@?[A-Za-z][A-Za-z0-9]*)\]")
SIMPLE = {"b": "**", "/b": "**", "i": "*", "/i": "*", "u": "", "/u": "", "center": "", "/center": "",
          "codeblocks": "", "/codeblocks": "", "lb": "\\[", "rb": "\\]"}


def code(text):
    """Code in a line; the marks are longer than any inside."""
    longest = max((len(run) for run in re.findall(r"`+", text)), default=0)
    pad = " " if longest else ""
    return "`" * (longest + 1) + pad + text + pad + "`" * (longest + 1)


def dedented(text):
    lines = text.split("\n")
    indents = [len(line) - len(line.lstrip()) for line in lines if line.strip()]
    return "\n".join(line[min(indents, default=0):] for line in lines)


def to_markdown(text, link):
    """link(kind, name) gives the Markdown of a reference; kind is class, method, member, signal, constant or enum."""
    kept = []

    def keep(markdown):
        kept.append(markdown)
        return f"\0{len(kept) - 1}\0"

    def block(found):
        kind, options, inside = found.groups()
        language = "csharp" if kind == "csharp" else "gdscript"
        if "lang=text" in options or not is_gdscript(inside):
            language = "text"
        return keep(f"\n\n```{language}\n{dedented(inside)}\n```\n\n")

    text = BLOCK.sub(block, text)
    text = CODE.sub(lambda found: keep(code(found.group(2))), text)
    text = PARAMETER.sub(lambda found: keep(code(found.group(1))), text)
    text = REFERENCE.sub(lambda found: keep(link(found.group(1), found.group(2))), text)
    text = URL.sub(lambda found: keep(f"[{found.group(2)}]({found.group(1)})"), text)
    # GDScript comments also mark code as Markdown does.
    text = re.sub(r"`[^`\n]+`", lambda found: keep(found.group(0)), text)
    text = re.sub(r"[ \t]*(?:\[br\][ \t]*\n?)+", "\n", text)
    for tag, mark in SIMPLE.items():
        text = text.replace(f"[{tag}]", keep(mark))
    text = CLASS.sub(lambda found: keep(link("class", found.group(1))), text)
    text = re.sub(r"([\\*_<>\[\]#])", r"\\\1", text)
    # Each line of a help text is a paragraph, or an item of a list.
    text = "\n\n".join(line.strip() for line in text.split("\n") if line.strip())
    text = re.sub(r"^(- .*)\n\n(?=- )", r"\1\n", text, flags=re.M)
    while re.search(r"\0\d+\0", text):
        text = re.sub(r"\0(\d+)\0", lambda found: kept[int(found.group(1))], text)
    return re.sub(r"\n{3,}", "\n\n", text).strip()


def is_gdscript(text):
    """Trees of nodes are drawn in blocks too."""
    return not re.search(r"[\u2500-\u257f]", text)
