"""The mutants of a C++ source, and a seeded draw among them.

Why a generator of our own: universalmutator (PyPI, 1.14.1), the kept tool for this, works by regular expressions on one
line at a time. It cannot drop a statement of two lines or return early from a function, takes references, pointers and
templates for operators, and of its mutants of our sources most do not compile; at some seconds a compilation that is
most of the time of a run. Mull and Dredd, which work on the compiler's own tree, have no package in Debian or PyPI.
This generator takes the source as tokens (cpp_tokens.py) and knows statements, conditions and operators.

A mutant is named PATH:LINE:COLUMN:KIND. The same tree and seed give the same order of mutants on every machine.
"""

import collections
import difflib
import hashlib
import math
import re

from cpp_tokens import CONTROL, NUMBER, OPENING, TEXT, WORD, Source

# How often a family of kinds is drawn, whatever the number of its mutants: a source has ten times more constants than
# conditions. Dropped statements are the most frequent since they survived most often.
WEIGHTS = {
    "drop-statement": 3, "drop-reset": 2, "condition": 2, "logical": 1, "relation": 2, "arithmetic": 2, "constant": 2,
    "swap-arguments": 1, "early-return": 1,
}
NO_STATEMENT = CONTROL | {
    "else", "do", "case", "default", "try", "using", "typedef", "static_assert", "struct", "class", "enum", "union",
    "const", "constexpr", "static", "auto", "template", "namespace", "goto", "throw", "}", ";", "[", ":",
}
RESET_CALL = re.compile(r"(?:reset|restart|clear|shut|fill)(?:_\w+)?")
RESET_VALUE = re.compile(
    r"-?[\d.][\w.']*|true|false|nullptr|\{\}|(?:\w+::)*[A-Z]\w*(?:\{\}|\(\))|(?:\w+::)+\w+")
NOT_A_CALL = CONTROL | {"return", "sizeof", "decltype", "static_assert", "noexcept", "alignas", "requires", "defined"}
COMMUTES = {"min", "max", "fmin", "fmax", "dot", "hypot", "swap", "distance"}
ASSIGNS = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="}
BOUNDARY = {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}
FLIP = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "==": "!=", "!=": "=="}
ARITHMETIC = {
    "+": "-", "-": "+", "*": "/", "/": "*", "%": "*", "&": "|", "|": "&", "<<": ">>", ">>": "<<",
    "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=", "&=": "|=", "|=": "&=", "<<=": ">>=", ">>=": "<<=",
}
INTEGER = re.compile(r"(0[xX][\da-fA-F']+|0[bB][01']+|\d[\d']*)([uUlLzZ]*)$")

Change = collections.namedtuple("Change", "family kind start end new")


class Mutant:
    """One change of one source."""

    def __init__(self, path, source, change):
        self.path = path
        self.family = change.family
        self.kind = change.kind
        self.line, self.column = source.place(change.start)
        self._before = source.text
        self._change = change

    @property
    def name(self):
        return f"{self.path}:{self.line}:{self.column}:{self.kind}"

    @property
    def text(self):
        """The whole source, changed. A line that is dropped stays as an empty one: the others keep their numbers."""
        start, end, new = self._change.start, self._change.end, self._change.new
        lines = self._before[start:end].count("\n") - new.count("\n")
        return self._before[:start] + new + "\n" * lines + self._before[end:]

    def diff(self):
        old, new = self._before.splitlines(), self.text.splitlines()
        lines = list(difflib.unified_diff(old, new, lineterm="", n=0))[2:]
        return "\n".join(line for line in lines if not line.startswith("@@") and line.strip() not in ("+", "-"))


# --- Statements ------------------------------------------------------------------------------------


def statements(source):
    """(first, last) tokens of each simple statement; the last is its semicolon."""
    tokens = source.tokens
    for index, token in enumerate(tokens):
        around = source.enclosing[index]
        if around is None or tokens[around].block not in ("code", "function") or token.text in NO_STATEMENT:
            continue
        before = source.word(index - 1)
        begins = (index - 1 == around or before == ";" or before == "}" and source.closes_block(index - 1)
                  or before == ":" and is_label(source, index - 1))
        if not begins:
            continue
        last = end_of_statement(source, index)
        if last is not None:
            yield index, last


def is_label(source, colon):
    index = colon
    while source.word(index - 1) not in (";", "{", "}", "?", ""):
        index -= 1
    return source.word(index) in ("case", "default")


def end_of_statement(source, index):
    while index < len(source.tokens):
        token = source.tokens[index]
        if token.text == ";":
            return index
        if token.text == "}" or token.text == "{" and token.partner is None:
            return None
        index = token.partner + 1 if token.text in OPENING and token.partner else index + 1
    return None


def is_declaration(source, index):
    """Type name ... : two names with nothing but ::, template arguments, * and & between them."""
    tokens = source.tokens
    if tokens[index].kind != WORD:
        return False
    index += 1
    while source.word(index) == "::":
        index += 2
    if source.word(index) == "<" and not source.spaced(index):
        depth = 0
        while index < len(tokens):
            depth += {"<": 1, ">": -1, ">>": -2}.get(source.word(index), 0)
            index += 1
            if depth <= 0:
                break
    while source.word(index) in ("*", "&", "&&", "const"):
        index += 1
    return index < len(tokens) and tokens[index].kind == WORD


def is_reset(source, first, last):
    """A call of reset() or the like, or the assignment of a constant."""
    tokens = source.tokens
    if source.word(last - 1) == ")":
        called = tokens[last - 1].partner - 1
        if tokens[called].kind == WORD and RESET_CALL.fullmatch(source.word(called)):
            return True
    sides = [index for index in range(first, last) if source.word(index) in ASSIGNS]
    if not sides or source.word(sides[-1]) != "=":
        return False
    value = "".join(source.word(index) for index in range(sides[-1] + 1, last))
    return bool(RESET_VALUE.fullmatch(value))


def drops(source):
    for first, last in statements(source):
        start, end = source.tokens[first].start, source.tokens[last].end
        word = source.word(first)
        if word == "return":
            brace = source.enclosing[first]
            owner = source.word(source.head(brace))
            after = source.word(source.tokens[brace].partner + 1)
            if owner == "if" and after not in ("else", "}"):
                yield Change("drop-statement", "drop-return", start, end, ";")
        elif word == "(" and source.word(first + 1) == "void":
            continue
        elif not is_declaration(source, first):
            kind = "drop-reset" if is_reset(source, first, last) else "drop-statement"
            yield Change(kind, kind, start, end, ";")


def early_returns(source):
    tokens = source.tokens
    for brace, token in enumerate(tokens):
        if token.block != "function" or token.partner in (None, brace + 1):
            continue
        result = result_type(source, brace)
        if not result or "auto" in result or "operator" in result:
            continue
        values = ["true", "false"] if result == ["bool"] else [""] if result == ["void"] else ["{}"]
        for value in values:
            kind = f"return-{value}" if len(values) > 1 else "early-return"
            yield Change("early-return", kind, token.end, token.end, f" return {value};".replace(" ;", ";"))


def result_type(source, brace):
    """The words of a function's result type; none for a constructor."""
    tokens = source.tokens
    index = source.head(brace)
    if source.word(index) == "template":
        depth = 0
        while index < brace:
            index += 1
            depth += {"<": 1, ">": -1, ">>": -2}.get(source.word(index), 0)
            if depth <= 0:
                break
        index += 1
    words = []
    while index < brace:
        word = source.word(index)
        if word in OPENING and tokens[index].partner:
            if word == "(":
                break
            index = tokens[index].partner
        elif word not in ("inline", "static", "constexpr", "virtual", "friend", "explicit", "const"):
            words.append(word)
        index += 1
    if words and words[-1] != "operator":
        words.pop()  # the function's name
        while words and words[-1] == "::":
            del words[-2:]
    return words


# --- Conditions ------------------------------------------------------------------------------------


def conditions(source):
    tokens = source.tokens
    for index, token in enumerate(tokens):
        if source.code_block(index) is None:
            continue
        if token.text in ("if", "while") and source.word(index + 1) == "(" and tokens[index + 1].partner:
            first, last = index + 2, tokens[index + 1].partner - 1
            for inside in range(first, last):
                if source.word(inside) == ";":
                    first = inside + 1
            if first <= last and source.word(first) not in ("const", "auto") and not is_declaration(source, first):
                yield negated(source, first, last)
        elif token.text == "?":
            yield negated(source, start_of_condition(source, index), index - 1)
        elif token.text == "!":
            yield Change("condition", "drop-not", token.start, token.end, "")


def negated(source, first, last):
    start, end = source.tokens[first].start, source.tokens[last].end
    return Change("condition", "negate-condition", start, end, f"!({source.text[start:end]})")


def start_of_condition(source, index):
    stops = ASSIGNS | {"return", ",", ";", "?", ":", "(", "[", "{", "<<"}
    while index > 0 and source.word(index - 1) not in stops:
        index = source.tokens[index - 1].partner if source.word(index - 1) in (")", "]", "}") else index - 1
    return index


# --- Operators -------------------------------------------------------------------------------------


def operators(source):
    for index, token in enumerate(source.tokens):
        if token.kind != "mark" or source.code_block(index) is None:
            continue
        text = token.text
        if text in ("++", "--"):
            yield Change("arithmetic", "step", token.start, token.end, "--" if text == "++" else "++")
        elif not source.spaced(index):
            if text == "-" and is_sign(source, index):
                yield Change("arithmetic", "drop-minus", token.start, token.end, "")
        elif text in ("&&", "||"):
            yield Change("logical", "logical", token.start, token.end, "||" if text == "&&" else "&&")
        elif text in FLIP:
            yield Change("relation", "flip-relation", token.start, token.end, FLIP[text])
            if text in BOUNDARY:
                yield Change("relation", "boundary", token.start, token.end, BOUNDARY[text])
        elif text in ARITHMETIC and not near_text(source, index):
            yield Change("arithmetic", "operator", token.start, token.end, ARITHMETIC[text])


def is_sign(source, index):
    before = source.tokens[index - 1]
    return before.kind == "mark" and before.text not in (")", "]") or before.text == "return"


def near_text(source, index):
    """Whether the statement holds a string: + then joins strings."""
    for step in (-1, 1):
        other = index
        while 0 <= other < len(source.tokens) and source.word(other) not in (";", "{", "}"):
            if source.tokens[other].kind == TEXT:
                return True
            other += step
    return False


# --- Values ----------------------------------------------------------------------------------------


def constants(source):
    for index, token in enumerate(source.tokens):
        if token.kind == WORD and token.text in ("true", "false") and source.word(index - 1) != "(":
            yield Change("constant", "flip-bool", token.start, token.end, "false" if token.text == "true" else "true")
        if token.kind == NUMBER and not is_part_of_type(source, index):
            for kind, text in other_values(token.text):
                yield Change("constant", kind, token.start, token.end, text)


def is_part_of_type(source, index):
    """Numbers that say what a type is, or which case is meant: another one does not compile, or nothing notices."""
    before, after = source.word(index - 1), source.word(index + 1)
    if before == "<" and not source.spaced(index - 1) or after in (">", ">>") and not source.spaced(index + 1):
        return True
    if before == "case" or before == "[" and source.code_block(index) is None:
        return True
    around = source.enclosing[index]
    while around is not None:
        opening = source.tokens[around]
        if opening.text == "(" and source.word(around - 1) in ("static_assert", "alignas", "noexcept"):
            return True
        if opening.block == "scope" and source.word(source.head(around)) == "enum":
            return True
        around = source.enclosing[around]
    return False


def other_values(text):
    whole = INTEGER.match(text)
    if whole:
        value = int(whole[1].replace("'", ""), 0) if whole[1].strip("0'") else 0
        yield "constant+1", f"{value + 1}{whole[2]}"
        if value > 0:
            yield "constant-1", f"{value - 1}{whole[2]}"
        return
    suffix = "f" if text[-1] in "fF" and not text.lower().startswith("0x") else ""
    if re.fullmatch(r"[0.']*(?:[eE].*)?[fF]?", text):
        yield "constant+1", f"1.0{suffix}"
    else:
        yield "constant*2", f"({text} * 2.0{suffix})"
        yield "constant/2", f"({text} * 0.5{suffix})"


def swapped_arguments(source):
    tokens = source.tokens
    for index, token in enumerate(tokens):
        if token.text != "(" or not token.partner or source.code_block(index) is None or index == 0:
            continue
        if tokens[index - 1].kind != WORD or source.word(index - 1) in NOT_A_CALL | COMMUTES:
            continue
        commas = [inside for inside in range(index + 1, token.partner)
                  if source.word(inside) == "," and source.enclosing[inside] == index]
        edges = [index, *commas, token.partner]
        for before, comma, after in zip(edges, edges[1:], edges[2:]):
            if comma - before < 2 or after - comma < 2:
                continue
            left, right = source.between(before + 1, comma - 1), source.between(comma + 1, after - 1)
            if left != right:
                start, end = tokens[before + 1].start, tokens[after - 1].end
                apart = source.text[tokens[comma - 1].end:tokens[comma + 1].start]
                yield Change("swap-arguments", "swap-arguments", start, end, right + apart + left)


# --- All of them -----------------------------------------------------------------------------------


def all_mutants(path, text):
    """The mutants of one source, in the order of the text."""
    source = Source(text)
    found = {}
    for maker in (drops, early_returns, conditions, operators, constants, swapped_arguments):
        for change in maker(source):
            mutant = Mutant(path, source, change)
            found.setdefault(mutant.name, mutant)
    return sorted(found.values(), key=lambda mutant: (mutant.line, mutant.column, mutant.kind))


def in_drawn_order(mutants, seed):
    """All the mutants, in a random order in which each family comes as often as its weight says. The place of a mutant
    depends on its name and the seed alone, but for the size of its family."""
    sizes = collections.Counter(mutant.family for mutant in mutants)

    def key(mutant):
        digest = hashlib.sha256(f"{seed} {mutant.name}".encode()).digest()
        uniform = (int.from_bytes(digest[:8], "big") + 1) / 2.0**64
        # Drawing without replacement by weight: Efraimidis and Spirakis, 2006.
        return -math.log(uniform) * sizes[mutant.family] / WEIGHTS[mutant.family], mutant.name

    return sorted(mutants, key=key)
