"""The class help as pages of the site: one for each class, and an index of them."""

import os
import re

import bbcode

HERE = os.path.dirname(os.path.abspath(__file__))
TITLES = (("member", "Properties"), ("method", "Methods"), ("signal", "Signals"), ("constant", "Constants"))


def label(*names):
    """The anchor of a class or of one of its items, one for the whole site."""
    return "-".join(["help", *names]).lower()


def enum_of(item):
    """The enumeration of a constant, without the class that it belongs to."""
    return item.type.rpartition(".")[2]


def anchor(owner, item):
    """Constants stand in tables: their anchor is that of the table."""
    if item.kind != "constant":
        return label(owner, item.name)
    return label(owner, "enum", enum_of(item)) if enum_of(item) else label(owner, "constants")


class Linker:
    """Markdown of references: to a class of ours, to an item of one, to a class of the engine."""

    def __init__(self, classes):
        self.items = {each.name: {item.name: item for item in each.items} for each in classes}
        self.enums = {each.name: {enum_of(item) for item in each.items if item.kind == "constant"} - {""}
                      for each in classes}
        with open(os.path.join(HERE, "site", "engine_class.txt"), encoding="utf-8") as file:
            self.engine = file.read().strip()

    def of_class(self, name):
        if name in self.items:
            return f"[`{name}`](#{label(name)})"
        if name == "void" or not re.fullmatch(r"@?[A-Za-z]\w*", name):
            return bbcode.code(name)
        return f"[`{name}`]({self.engine.format(name=name.lower())})"

    def of_type(self, name):
        """A type in a signature: arrays, and enumerations by CLASS.ENUM."""
        inner = re.fullmatch(r"(.+)\[\]", name)
        if inner:
            return f"`Array` of {self.of_type(inner.group(1))}"
        owner, _, enum = name.partition(".")
        if enum:
            return f"[`{enum}`](#{label(owner, 'enum', enum)})" if enum in self.enums.get(owner, ()) else bbcode.code(name)
        return self.of_class(name)

    def inside(self, own):
        """link(kind, name) for the texts of the class `own`."""
        def link(kind, name):
            if kind == "class":
                return self.of_class(name)
            owner, _, item = name.rpartition(".")
            owner = owner or own
            shown = f"{item}()" if kind == "method" else item
            shown = shown if owner == own else f"{owner}.{shown}"
            if kind == "enum" and item in self.enums.get(owner, ()):
                return f"[`{shown}`](#{label(owner, 'enum', item)})"
            if kind != "enum" and item in self.items.get(owner, ()):
                return f"[`{shown}`](#{anchor(owner, self.items[owner][item])})"
            return bbcode.code(shown) if owner in self.items else f"[`{shown}`]({self.engine.format(name=owner.lower())})"
        return link


def signature(item):
    """What a reader types: name(arguments) or name = default."""
    def argument(name, kind, default):
        return f"{name}: {kind}" + (f" = {default}" if default is not None else "")
    arguments = ", ".join(argument(*each) for each in item.arguments)
    if item.kind == "method":
        return f"{item.name}({arguments}) -> {item.type or 'void'}" + (f" {item.qualifiers}" if item.qualifiers else "")
    if item.kind == "signal":
        return f"{item.name}({arguments})"
    return f"{item.name}: {item.type} = {item.default}" if item.kind == "member" and item.default else \
        f"{item.name}: {item.type}" if item.kind == "member" else f"{item.name} = {item.default}"


def item_lines(each, item, linker):
    yield f"({label(each.name, item.name)})="
    yield f"### {item.name.replace('_', chr(92) + '_')}\n"
    yield f"```gdscript\n{signature(item)}\n```\n"
    if item.kind == "member":
        yield f"Type: {linker.of_type(item.type)}.\n"
    yield bbcode.to_markdown(item.text, linker.inside(each.name)) + "\n"


def constant_lines(each, constants, linker):
    """Tables: one for the constants of no enumeration, one for each enumeration."""
    for enum in sorted({enum_of(item) for item in constants}):
        if enum:
            yield f"({label(each.name, 'enum', enum)})="
            yield f"### enum {enum}\n"
        yield "| name | value | meaning |\n|---|---|---|"
        for item in constants:
            if enum_of(item) == enum:
                text = bbcode.to_markdown(item.text, linker.inside(each.name)).replace("\n\n", " ").replace("|", "\\|")
                yield f"| `{item.name}` | `{item.default}` | {text} |"
        yield ""


def page(each, linker):
    """The Markdown of one class."""
    lines = [f"({label(each.name)})=", f"# {each.name}\n",
             f"Inherits {linker.of_class(each.inherits)}. The same text is in the editor's help: F1, `{each.name}`.\n",
             bbcode.to_markdown(each.brief, linker.inside(each.name)) + "\n",
             bbcode.to_markdown(each.description, linker.inside(each.name)) + "\n"]
    for kind, title in TITLES:
        items = [item for item in each.items if item.kind == kind]
        if items:
            lines.append(f"({label(each.name, title)})=\n## {title}\n")
            if kind == "constant":
                lines += constant_lines(each, items, linker)
            else:
                for item in sorted(items, key=lambda item: item.name):
                    lines += item_lines(each, item, linker)
    return "\n".join(lines) + "\n"


def index(classes, linker):
    rows = [f"| {linker.of_class(each.name)} | {bbcode.to_markdown(each.brief, linker.inside(each.name))} |"
            for each in classes]
    return "\n".join(["# Class reference\n",
                      "Every class of the add-on, with its properties, methods, signals and constants. The editor shows "
                      "the same text: F1, then the name of the class.\n",
                      "| class | what it is |", "|---|---|", *rows, "",
                      "```{toctree}", ":hidden:", "", *[each.name.lower() for each in classes], "```", ""])


def write(classes, folder):
    linker = Linker(classes)
    os.makedirs(folder, exist_ok=True)
    for name, text in [("index", index(classes, linker)), *[(each.name.lower(), page(each, linker)) for each in classes]]:
        with open(os.path.join(folder, f"{name}.md"), "w", encoding="utf-8") as file:
            file.write(text)
