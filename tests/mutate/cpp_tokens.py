"""C++ source as tokens: no comments, no preprocessor lines, and what each brace is for.

This is not a parser. It knows enough of C++, as clang-format lays it out, to find statements and binary operators.
Where it is wrong, the mutant does not compile and another one is drawn.
"""

import bisect
import re

WORD, NUMBER, TEXT, MARK = "word", "number", "text", "mark"

PATTERN = re.compile(
    r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/|\#(?:[^\n\\]|\\.)*)
      | (?P<text>(?:u8|[uUL])?R"(?P<fence>[^()\\\s]*)\(.*?\)(?P=fence)"
          |(?:u8|[uUL])?"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)+')
      | (?P<number>\.?\d(?:[eEpP][+-]|'?[\w.])*)
      | (?P<word>[A-Za-z_]\w*)
      | (?P<mark><<=|>>=|<=>|->\*|\.\.\.|::|->|\+\+|--|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|.)""",
    re.VERBOSE | re.DOTALL,
)
OPENING = {"(": ")", "[": "]", "{": "}"}
SCOPES = {"class", "struct", "union", "enum", "namespace"}
OF_A_TYPE = {"::", "<", ">", ",", "*", "&"}
CONTROL = {"if", "for", "while", "switch", "catch"}


class Token:
    __slots__ = ("kind", "text", "start", "end", "partner", "block")

    def __init__(self, kind, text, start):
        self.kind = kind
        self.text = text
        self.start = start
        self.end = start + len(text)
        self.partner = None  # index of the bracket that belongs to this one
        self.block = None  # of a brace: "code", "function" (code too), "scope" or "value"

    def __repr__(self):
        return self.text


class Source:
    """The tokens of one file. `enclosing[i]` is the index of the bracket around token i, or None."""

    def __init__(self, text):
        self.text = text
        self.line_starts = [0] + [found.end() for found in re.finditer("\n", text)]
        self.tokens = []
        for found in PATTERN.finditer(text):
            if found.lastgroup != "skip" and not found.group("skip"):
                kind = next(name for name in (TEXT, NUMBER, WORD, MARK) if found.group(name))
                self.tokens.append(Token(kind, found.group(), found.start()))
        self.enclosing = self._match_brackets()
        for index, token in enumerate(self.tokens):
            if token.text == "{" and token.partner is not None:
                token.block = self._block(index)

    def place(self, position):
        """(line, column), both from 1."""
        line = bisect.bisect_right(self.line_starts, position)
        return line, position - self.line_starts[line - 1] + 1

    def word(self, index):
        return self.tokens[index].text if 0 <= index < len(self.tokens) else ""

    def between(self, first, last):
        """The text from token `first` to token `last`, both included."""
        return self.text[self.tokens[first].start:self.tokens[last].end]

    def spaced(self, index):
        """White space on both sides: so clang-format writes binary operators, and no unary ones, references or angle
        brackets."""
        token = self.tokens[index]
        return self.text[token.start - 1].isspace() and self.text[token.end:token.end + 1].isspace()

    def code_block(self, index):
        """The innermost code block that token `index` lies in, as the index of its brace; None outside functions."""
        around = self.enclosing[index]
        while around is not None:
            if self.tokens[around].block in ("code", "function"):
                return around
            if self.tokens[around].block == "scope":
                return None
            around = self.enclosing[around]
        return None

    def head(self, brace):
        """Index of the first token of what the brace at `brace` belongs to: after the last ; { } or : before it."""
        index = brace - 1
        while index >= 0:
            text = self.word(index)
            if text in (")", "]") or (text == "}" and self.tokens[self.tokens[index].partner].block == "value"):
                index = self.tokens[index].partner - 1
                continue
            if text in (";", "{", "}", "(", "["):
                break
            if text == ":" and self.word(index - 1) in ("public", "private", "protected"):
                break
            index -= 1
        return index + 1

    def closes_block(self, index):
        """Whether the } at `index` ends code or a scope, not a value."""
        partner = self.tokens[index].partner
        return partner is not None and self.tokens[partner].block != "value"

    def _match_brackets(self):
        open_ones, enclosing = [], []
        for index, token in enumerate(self.tokens):
            if token.text in (")", "]", "}") and token.kind == MARK and open_ones:
                token.partner = open_ones.pop()
                self.tokens[token.partner].partner = index
            enclosing.append(open_ones[-1] if open_ones else None)
            if token.text in OPENING and token.kind == MARK:
                open_ones.append(index)
        return enclosing

    def _block(self, brace):
        before = self.word(brace - 1)
        in_code = self.code_block(brace) is not None
        if before in ("", ";", "{", "}", ":") and (before != "}" or self.closes_block(brace - 1)):
            return "code" if in_code else "scope"
        if before in ("else", "do", "try"):
            return "code"
        words = [self.word(index) for index in range(self.head(brace), brace)]
        if SCOPES & set(words) and "(" not in words or words[:1] == ["extern"]:
            return "scope"
        index = brace - 1
        while self.word(index) in ("const", "noexcept", "override", "final", "mutable", "&", "&&") or (
                self.word(index) == ")" and self.word(self.tokens[index].partner - 1) in ("noexcept", "requires")):
            index = self.tokens[index].partner - 2 if self.word(index) == ")" else index - 1
        if self.word(index) in (")", "]") or self._returns(index) or "requires" in words:
            # A control statement's block, or a lambda's, or a function's.
            owner = self.word(self.tokens[index].partner - 1) if self.word(index) == ")" else ""
            return "code" if in_code or owner in CONTROL or owner == "]" or self.word(index) == "]" else "function"
        if before == "}" and not in_code and "(" in words:
            return "function"  # after a constructor's list of values
        return "value"

    def _returns(self, index):
        """Whether the tokens up to `index` are a trailing return type: ) -> Type."""
        while index > 0 and (self.tokens[index].kind in (WORD, NUMBER) or self.word(index) in OF_A_TYPE):
            index -= 1
        return self.word(index) == "->" and self.word(index - 1) in (")", "noexcept", "mutable")
