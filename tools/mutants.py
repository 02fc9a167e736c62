"""The changes of mutation testing (tools/mutate.py): one operator, sign or number of a source at a time."""
import collections
import dataclasses
import random
import re


@dataclasses.dataclass(frozen=True)
class Mutant:
    """Bytes [begin, end) of a file replaced by others."""
    path: str
    begin: int
    end: int
    old: str
    new: str
    line: int   # from 1
    text: str   # of the line, as it was
    place: int = 1  # among equal changes of equal lines of the file

    @property
    def key(self):
        """An identifier that stays equal between versions of the sources, so without line numbers."""
        return f"{self.path}: {self.text} : {self.change}" + (f" #{self.place}" if self.place > 1 else "")

    @property
    def change(self):
        return f"{self.old.strip()} -> {self.new.strip() or 'nothing'}"

    def apply(self, source):
        return source[:self.begin] + self.new + source[self.end:]


def code_only(source):
    """The source with comments, texts, characters and preprocessor lines blanked out, every other character in its place."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\\n])*\'|^[ \t]*#[^\n]*', re.DOTALL | re.MULTILINE)
    return pattern.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), source)


# The formatter puts blanks around operators of two operands and nowhere else, so that `a < b` is a comparison and `array<T>` is none.
OPERATORS = {"+": "-", "-": "+", "*": "/", "/": "*", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
             "<": ">=", "<=": ">", ">": "<=", ">=": "<", "==": "!=", "!=": "==", "&&": "||", "||": "&&"}
TWO_OPERANDS = re.compile(r"(?<=[\w)\]}] )(?:[-+*/]=?|[<>]=?|[=!]=|&&|\|\|)(?=\s)")
LEADING_OPERATOR = re.compile(r"(?<=\n)(?P<blank>[ ]+)(?P<operator>[-+*/]|&&|\|\|)(?= )")
MINUS = re.compile(r"(?:(?<=[(,={?:<>*/+] )|(?<=[({\[])|(?<=return ))-(?=[\w(])")
NOT = re.compile(r"!(?=[\w(])")
MIN_MAX = re.compile(r"\b(?:min|max)(?=\()")
TRUTH = re.compile(r"\b(?:true|false)\b")
REAL = re.compile(r"(?<![\w.])(?:\d+\.\d+(?:e[-+]?\d+)?|\d+e[-+]?\d+)(?![\w.])")
INTEGER = re.compile(r"(?<![\w.])\d+(?= [-+*/] )|(?<= [*/] )\d+(?![\w.'])")
# The value of a whole expression, one per cent too large: what tests have a number for they must have to better than that.
VALUE = re.compile(r"(?:\b(?:Real|T) \w+ = |\breturn )(?P<value>[^;{}?\n]+)(?=;)")
NO_NUMBER = re.compile(r"[<>=!]=|&&|\|\||[^-]>(?!\()| < | = |!|\b(?:true|false|none|nullptr|std::move)\b|\b(?:is|has|can|are|everywhere|somewhere)(?:_\w+)?\b|\*this|\"")
NOT_JUDGED = re.compile(r"\b(?:static_assert|assert|throw)\b")
SMALLEST = 1e-6  # numbers below are tolerances: no test has to know them to a per cent
BY = 1.01


def scaled(literal):
    return f"{float(literal) * BY:.12g}"


def finds(code):
    """(begin, end, new) of every change of a source that was blanked by code_only."""
    for m in TWO_OPERANDS.finditer(code):
        yield m.start(), m.end(), OPERATORS[m.group()]
    for m in LEADING_OPERATOR.finditer(code):
        yield m.start("operator"), m.end("operator"), OPERATORS[m.group("operator")]
    for pattern in (MINUS, NOT):
        for m in pattern.finditer(code):
            yield m.start(), m.end(), ""
    for m in MIN_MAX.finditer(code):
        yield m.start(), m.end(), {"min": "max", "max": "min"}[m.group()]
    for m in TRUTH.finditer(code):
        yield m.start(), m.end(), {"true": "false", "false": "true"}[m.group()]
    for m in REAL.finditer(code):
        if abs(float(m.group())) >= SMALLEST:
            yield m.start(), m.end(), scaled(m.group())
    for m in INTEGER.finditer(code):
        yield m.start(), m.end(), str(int(m.group()) + 1)
    for m in VALUE.finditer(code):
        value = m.group("value")
        if not NO_NUMBER.search(value) and not re.fullmatch(r"[\s\d.]+", value):
            yield m.start("value"), m.end("value"), f"{BY} * ({value})"


def mutants_of(path, source):
    """Every change of one source, in the order of its characters."""
    found = []
    times = collections.Counter()
    for begin, end, new in sorted(set(finds(code_only(source)))):
        line_begin = source.rfind("\n", 0, begin) + 1
        line_end = source.find("\n", begin)
        text = source[line_begin:line_end if line_end >= 0 else len(source)]
        if not NOT_JUDGED.search(text):
            old = source[begin:end]
            if new.startswith(f"{BY} * ("):
                new = f"{BY} * ({old})"   # with its texts, which code_only left out
            times[text.strip(), old, new] += 1
            found.append(Mutant(path, begin, end, old, new, source.count("\n", 0, begin) + 1, text.strip(), times[text.strip(), old, new]))
    return found


def mutants_of_group(root, patterns):
    paths = sorted({p for pattern in patterns for p in root.glob(pattern)})
    return [m for p in paths for m in mutants_of(str(p.relative_to(root)), p.read_text())]


def sample(name, mutants, size, seed):
    """A larger sample begins with the smaller one."""
    order = list(mutants)
    random.Random(f"{seed}:{name}").shuffle(order)
    return order[:size]
