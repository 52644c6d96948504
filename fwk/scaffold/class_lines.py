"""Lines of a class in a concrete syntax tree: annotated attributes are found, added and removed."""

import re
from collections.abc import Sequence

import libcst as cst

from fwk.plan.files.launch_file import shown
from fwk.scaffold.changes import ScaffoldError
from fwk.scaffold.source import Source

Line = cst.SimpleStatementLine | cst.BaseCompoundStatement


def lines_of(class_: cst.ClassDef) -> list[Line]:
    """Returns the lines of a class; those of a class on one line as if each had a line of its own."""
    if isinstance(class_.body, cst.IndentedBlock):
        return [each for each in class_.body.body if isinstance(each, Line)]
    return [
        cst.SimpleStatementLine([each.with_changes(semicolon=cst.MaybeSentinel.DEFAULT)])
        for each in class_.body.body
        if isinstance(each, cst.BaseSmallStatement)
    ]


def with_lines(class_: cst.ClassDef, lines: Sequence[Line]) -> cst.ClassDef:
    """Returns a class with these lines; an empty class gets a `pass`."""
    body = [*lines] or [cst.SimpleStatementLine([cst.Pass()])]
    if isinstance(class_.body, cst.IndentedBlock):
        return class_.with_changes(body=class_.body.with_changes(body=body))
    header = cst.ensure_type(class_.body, cst.SimpleStatementSuite).trailing_whitespace
    return class_.with_changes(body=cst.IndentedBlock(body, header))


def annotated(line: Line) -> dict[str, cst.AnnAssign]:
    """Returns the annotated attributes of a line by name."""
    small = line.body if isinstance(line, cst.SimpleStatementLine) else ()
    return {
        each.target.value: each
        for each in small
        if isinstance(each, cst.AnnAssign) and isinstance(each.target, cst.Name)
    }


def attributes(class_: cst.ClassDef) -> dict[str, cst.AnnAssign]:
    """Returns the annotated attributes of a class by name."""
    return {name: each for line in lines_of(class_) for name, each in annotated(line).items()}


def is_text(line: Line) -> bool:
    """Returns whether a line is a docstring."""
    return (
        isinstance(line, cst.SimpleStatementLine)
        and len(line.body) == 1
        and isinstance(line.body[0], cst.Expr)
        and isinstance(line.body[0].value, cst.SimpleString | cst.ConcatenatedString)
    )


def without(lines: Sequence[Line], attribute: str, with_text: bool = False) -> list[Line]:
    """Returns lines without an annotated attribute; `with_text` removes the docstring below, too.

    Comments above the attribute stay where they are.
    """
    kept: list[Line] = []
    left: list[cst.EmptyLine] = []
    removed = False
    for line in lines:
        if attribute in annotated(line):
            simple = cst.ensure_type(line, cst.SimpleStatementLine)
            small = [each for each in simple.body if each is not annotated(line)[attribute]]
            if small:
                small[-1] = small[-1].with_changes(semicolon=cst.MaybeSentinel.DEFAULT)
                kept.append(simple.with_changes(body=small))
            else:
                left, removed = list(simple.leading_lines), True
            continue
        if removed and with_text and is_text(line):
            removed = False
            continue
        removed = False
        if left:
            line = line.with_changes(leading_lines=_joined(left, list(line.leading_lines)))
            left = []
        kept.append(line)
    return kept


def _joined(before: list[cst.EmptyLine], after: list[cst.EmptyLine]) -> list[cst.EmptyLine]:
    """Joins empty lines and comments; where both meet with blank lines, those of the second part stay."""
    while before and after and before[-1].comment is None and after[0].comment is None:
        before = before[:-1]
    return [*before, *after]


def with_line(source: Source, lines: Sequence[Line], text: str, order: Sequence[str] = ()) -> list[Line]:
    """Returns the lines of a class with another annotated line, below the last one that comes before it in `order`."""
    made = parsed(source, text)
    lines = [each for each in lines if not is_empty(each)]
    ports = [place for place, each in enumerate(lines) if annotated(each)]
    rank = _rank(source, made, order)
    lower = [place for place in ports if _rank(source, lines[place], order) <= rank]
    if ports:
        place = (lower or ports)[-1]
        while place + 1 < len(lines) and is_text(lines[place + 1]):
            place += 1
    else:
        plain = [at for at, each in enumerate(lines) if isinstance(each, cst.SimpleStatementLine)]
        place = plain[-1] if plain else -1
        if place >= 0:
            made = made.with_changes(leading_lines=[cst.EmptyLine(indent=False)])
    return [*lines[: place + 1], made, *lines[place + 1 :]]


def _rank(source: Source, line: Line, order: Sequence[str]) -> int:
    for each in annotated(line).values():
        words = re.findall(r"fwk\.(\w+)", source.meaning(each.annotation.annotation))
        return next((1 + place for place, word in enumerate(order) if word in words), 0)
    return 0


def parsed(source: Source, text: str) -> cst.SimpleStatementLine:
    """Returns a line of code with the line ends and indentation of the file.

    Raises:
        ScaffoldError: the text is not valid Python, since a word in it is a keyword, or its quotes end too early.
    """
    try:
        made = cst.parse_statement(text, config=source.module.config_for_parsing)
    except cst.ParserSyntaxError as error:
        raise ScaffoldError(
            f"'{text}' is not valid Python; choose a name that is not a keyword, and a plain text"
        ) from error
    return cst.ensure_type(made, cst.SimpleStatementLine)


def is_empty(line: Line) -> bool:
    """Returns whether a line only says that a class has no content: `pass` or `...`."""
    if not isinstance(line, cst.SimpleStatementLine) or len(line.body) != 1:
        return False
    only = line.body[0]
    return isinstance(only, cst.Pass) or (isinstance(only, cst.Expr) and isinstance(only.value, cst.Ellipsis))


def taken(source: Source, there: cst.AnnAssign, name: str, class_: str = "") -> str:
    """Returns the message that a class has another attribute of that name."""
    where = f"{source.place(there)}: {class_ or source.class_name}"
    return f"{where} has '{code_of(source, there)}' already; choose another name, or remove '{name}' first"


def code_of(source: Source, node: cst.CSTNode) -> str:
    """Returns a node as it is written in the file."""
    return source.module.code_for_node(node).strip()


def value_of(source: Source, node: cst.AnnAssign) -> str:
    """Returns the value of an annotated attribute as it is written; empty if it has none."""
    return code_of(source, node.value) if node.value is not None else ""


def uses(source: Source, text: str) -> list[str]:
    """Returns the places of a name such as `self.ball` in the file, as `FILE:LINE`."""
    word = re.compile(rf"(?<![\w.])(self\.)?{re.escape(text)}\b")
    lines = source.module.code.splitlines()
    return [f"{shown(source.path)}:{number}" for number, line in enumerate(lines, 1) if word.search(line)]
