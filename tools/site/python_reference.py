"""The reference of the Python package as a page: signatures and docstrings of everything in `talus.__all__`, by module.

The page is made when the site is built, so it is never older than the package.  A public function or class without a docstring is an error.
"""
import importlib
import inspect
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COLUMNS = re.compile(r"^\s+\S|\S {2,}(?<!\. {2})\S", re.M)    # of a paragraph whose line breaks mean something: a table, or indented
SPECIAL = re.compile(r"(`[^`]*`)|([\\*_<>#|\[\]])")


def escaped(text):
    """A text in which Markdown has nothing to read but code in backticks."""
    return SPECIAL.sub(lambda match: match[1] or "\\" + match[2], text)


def paragraphs(docstring):
    """A docstring as Markdown; paragraphs with columns or indentation stay as they are."""
    for paragraph in inspect.cleandoc(docstring).split("\n\n"):
        has_columns = COLUMNS.search(paragraph.replace(".  ", ". "))
        yield f"```text\n{paragraph}\n```" if has_columns else escaped(paragraph)


def signature_of(name, member):
    """`name(arguments)`, without the types of the arguments, which docstrings explain."""
    try:
        arguments = inspect.signature(member)
    except (TypeError, ValueError):
        return name
    plain = [p.replace(annotation=inspect.Parameter.empty) for p in arguments.parameters.values() if p.name not in ("self", "cls")]
    return name + str(arguments.replace(parameters=plain, return_annotation=inspect.Signature.empty))


def members_of(owner):
    """(name, member) of the public methods and properties that the class itself documents."""
    for name, member in vars(owner).items():
        function = member.__func__ if isinstance(member, (classmethod, staticmethod)) else member
        if name.startswith("_") or not (inspect.isfunction(function) or isinstance(function, property)):
            continue
        if inspect.getdoc(function):
            yield name, function


def entry(name, thing, missing):
    """The section of one function or class."""
    text = inspect.getdoc(thing)
    if not text:
        missing.append(name)
        return
    yield f"### {escaped(name)}"
    yield f"```python\n{'class ' if inspect.isclass(thing) else ''}talus.{signature_of(name, thing)}\n```"
    yield from paragraphs(text)
    if not inspect.isclass(thing):
        return
    for member_name, member in members_of(thing):
        shown = member_name if isinstance(member, property) else signature_of(member_name, member)
        yield f"#### {escaped(name)}.{escaped(member_name)}"
        yield f"```python\n{shown}\n```"
        yield from paragraphs(inspect.getdoc(member))


def page():
    """The page in Markdown.  Raises ValueError with the names of what has no docstring."""
    sys.dont_write_bytecode, kept = True, sys.dont_write_bytecode
    sys.path.insert(0, str(ROOT / "python"))
    talus = importlib.import_module("talus")
    sys.path.pop(0)
    sys.dont_write_bytecode = kept
    parts, missing = ["# Python: functions and classes", *paragraphs(talus.__doc__)], []
    by_module, constants = {}, []
    for name in talus.__all__:
        thing = getattr(talus, name)
        if inspect.isfunction(thing) or inspect.isclass(thing):
            by_module.setdefault(thing.__module__, []).append((name, thing))
        else:
            constants.append(f"| `talus.{name}` | `{str(thing)[:100].replace('|', '/')}` |")
    for module, things in sorted(by_module.items()):
        summary = (inspect.getdoc(sys.modules[module]) or "").split("\n\n")[0]
        parts += [f"## {escaped(module)}", escaped(summary)]
        for name, thing in things:
            parts += entry(name, thing, missing)
    parts += ["## Constants", "\n".join(["| name | value |", "|---|---|", *constants])]
    if missing:
        raise ValueError("no docstring: " + ", ".join(missing))
    return "\n\n".join(parts) + "\n"


if __name__ == "__main__":
    print(page(), end="")
