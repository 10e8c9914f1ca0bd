#!/usr/bin/env python3
"""Lists help texts that say too little: check_help.py GODOT [--strict]

Reads every text of gdextension/doc_classes and of the classes of addons/spidar_g/nodes. A text is listed if
  - it is empty,
  - it has fewer than 40 characters, without its markup,
  - or it has no verb: none of its words outside code is an auxiliary (is, has, can, must, ...) or a form of a verb of
    verbs.txt (the verb itself, or the verb with -s, -es, -d or -ed), and no word that ends in -s stands before an article
    or "each" ("limits the force").
The last rule is rough: it passes some texts that have no verb.
Without --strict the exit code is 0. The last line is "N passed, N failed", which counts texts.
"""

import os
import re
import sys

import class_help

FEWEST_CHARACTERS = 40
AUXILIARIES = set("is are was were be been has have had do does did can could may might must shall should will would"
                  " isn't aren't doesn't don't cannot can't".split())
WITH_OBJECT = re.compile(r"[a-z]s (?:the|an?|each) ")
SHOWN = 100  # of a text, in characters


def read_verbs():
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "verbs.txt"), encoding="utf-8") as file:
        return {line.strip() for line in file if line.strip() and not line.startswith("#")}


def plain(text):
    """The text as it is read: no code blocks, names in place of references."""
    text = re.sub(r"\[(codeblocks?|gdscript|csharp)\b.*?\[/\1\]", " ", text, flags=re.S)
    text = re.sub(r"\[(?:method|member|signal|constant|enum|param|annotation)\s+([^\]]+)\]", r"\1", text)
    text = re.sub(r"\[url[^\]]*\]|\[/?(?:br|b|i|u|code|kbd|url|center)\]", " ", text)
    return re.sub(r"\s+", " ", re.sub(r"\[(\w+)\]", r"\1", text)).strip()


def has_verb(text, verbs):
    text = re.sub(r"\[code\].*?\[/code\]", " ", text, flags=re.S)
    text = plain(text).lower()
    if WITH_OBJECT.search(text):
        return True
    for word in re.findall(r"[a-z]+(?:'[a-z]+)?", text):
        stems = {word} | {word.removesuffix(ending) for ending in ("s", "es", "d", "ed") if word.endswith(ending)}
        if word in AUXILIARIES or stems & verbs:
            return True
    return False


def fault(text, verbs):
    """What is wrong with a help text; None if nothing is."""
    shown = plain(text)
    if not shown:
        return "empty"
    if len(shown) < FEWEST_CHARACTERS:
        return f"{len(shown)} characters"
    return None if has_verb(text, verbs) else "no verb"


def texts_of(each):
    """(name, text) of everything that the class says. A class needs its brief description; the long one may be empty."""
    yield each.name, each.brief
    if each.description.strip():
        yield f"{each.name}, description", each.description
    for item in each.items:
        yield f"{each.name}.{item.name} ({item.kind})", item.text


def faults(classes, verbs):
    """[(source, name, fault or None, text)]"""
    return [(each.source, name, fault(text, verbs), plain(text)) for each in classes for name, text in texts_of(each)]


def main(arguments):
    strict = "--strict" in arguments
    words = [word for word in arguments if word != "--strict"]
    if len(words) != 1:
        sys.exit(__doc__)
    found = faults(class_help.read_all(words[0]), read_verbs())
    bad = [row for row in found if row[2]]
    for source, name, what, text in bad:
        print(f"{'FAIL' if strict else 'note'} {source}: {name}: {what}: {text[:SHOWN]}")
    print(f"{len(found) - len(bad)} passed, {len(bad)} failed")
    return 1 if strict and (bad or not found) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
