"""Adds and removes single imported names of a module, in the order in which ruff and isort keep them."""

from collections.abc import Sequence

import libcst as cst

from fwk.scaffold.source import Source, dotted, imports

_LINE_MAX = 120


def add_import(source: Source, module: str, name: str) -> str:
    """Makes `module.name` available in a source, unless it is; returns how to write it there."""
    full = f"{module}.{name}"
    if (known := source.short(full)) is not None:
        return known
    taken = name in source.imported() or name in source.classes()
    local = f"{module.rpartition('.')[2]}_{name}" if taken else name
    alias = cst.ImportAlias(cst.Name(name), cst.AsName(cst.Name(local)) if taken else None)
    for statement in imports(source.module):
        if isinstance(statement, cst.ImportFrom) and statement.module and dotted(statement.module) == module:
            if isinstance(statement.names, cst.ImportStar) or statement.relative:
                continue
            source.replace(statement, _with(source, statement, alias))
            return local
    statement_ = cst.ImportFrom(_module_name(module), [alias])
    _insert(source, cst.SimpleStatementLine([statement_]), module)
    return local


def remove_unused(source: Source, full: str) -> None:
    """Removes the import of a name that is not used in the source any more."""
    for statement in imports(source.module):
        if (
            not isinstance(statement, cst.ImportFrom)
            or not statement.module
            or isinstance(statement.names, cst.ImportStar)
        ):
            continue
        for alias in statement.names:
            local = alias.evaluated_alias or alias.evaluated_name
            if f"{dotted(statement.module)}.{alias.evaluated_name}" == full and not _used(
                source.module, statement, local
            ):
                left = [each for each in statement.names if each is not alias]
                _replace(source, statement, _names(statement, left) if left else None)
                return


def _used(module: cst.Module, statement: cst.ImportFrom, name: str) -> bool:
    """Returns whether a name occurs outside of an import statement, also in a text such as that of `__all__`."""
    return _count(module, name) > _count(statement, name)


def _count(node: cst.CSTNode, name: str) -> int:
    """Returns how often a name occurs in a node, also as a text."""
    own = isinstance(node, cst.Name) and node.value == name
    own |= isinstance(node, cst.SimpleString) and node.raw_value == name
    return own + sum(_count(child, name) for child in node.children)


def _replace(source: Source, old: cst.ImportFrom, new: cst.ImportFrom | None) -> None:
    if new is not None:
        source.replace(old, new)
        return
    for line in source.module.body:
        if isinstance(line, cst.SimpleStatementLine) and old in line.body:
            small = [each for each in line.body if each is not old]
            if small:
                source.replace(line, line.with_changes(body=small))
            else:
                source.module = source.module.with_changes(
                    body=[each for each in source.module.body if each is not line]
                )


def _key(name: str) -> tuple[int, str]:
    """Returns the place of a name in an import: constants, classes, others."""
    return (0 if name.isupper() and len(name) > 1 else 1 if name[0].isupper() else 2, name)


def _with(source: Source, statement: cst.ImportFrom, alias: cst.ImportAlias) -> cst.ImportFrom:
    names = list(statement.names) if not isinstance(statement.names, cst.ImportStar) else []
    place = sum(_key(each.evaluated_name) < _key(alias.evaluated_name) for each in names)
    made = _names(statement, [*names[:place], alias, *names[place:]])
    one_line = statement.lpar is None
    if one_line and len(source.module.code_for_node(made).rstrip()) > _LINE_MAX:
        return _wrapped(made)
    return made


def _names(statement: cst.ImportFrom, names: list[cst.ImportAlias]) -> cst.ImportFrom:
    """Returns a statement with these names, separated as its names were."""
    before = [] if isinstance(statement.names, cst.ImportStar) else list(statement.names)
    last = before[-1].comma
    between = next((each.comma for each in before[:-1] if isinstance(each.comma, cst.Comma)), None)
    if between is None:
        between = (
            last
            if isinstance(last, cst.Comma) and statement.lpar
            else cst.Comma(whitespace_after=cst.SimpleWhitespace(" "))
        )
    separated = [
        each if isinstance(each.comma, cst.Comma) and each is not before[-1] else each.with_changes(comma=between)
        for each in names[:-1]
    ]
    return statement.with_changes(names=[*separated, names[-1].with_changes(comma=last)])


def _wrapped(statement: cst.ImportFrom) -> cst.ImportFrom:
    """Returns a statement with each name on a line of its own, in parentheses."""
    inner = cst.ParenthesizedWhitespace(indent=True, last_line=cst.SimpleWhitespace("    "))
    outer = cst.ParenthesizedWhitespace(indent=True)
    names = [] if isinstance(statement.names, cst.ImportStar) else list(statement.names)
    placed = [each.with_changes(comma=cst.Comma(whitespace_after=inner)) for each in names[:-1]]
    return statement.with_changes(
        lpar=cst.LeftParen(whitespace_after=inner),
        names=[*placed, names[-1].with_changes(comma=cst.Comma(whitespace_after=outer))],
        rpar=cst.RightParen(),
    )


def _insert(source: Source, line: cst.SimpleStatementLine, module: str) -> None:
    """Puts an import below the last one of a module that comes before it, or below the other imports."""
    body = list(source.module.body)
    places = [place for place, each in enumerate(body) if _imported_from(each) is not None]
    lower = [place for place in places if (_imported_from(body[place]) or "") < module]
    fwk = [place for place in lower if (_imported_from(body[place]) or "").partition(".")[0] in ("fwk", "lcmtypes")]
    place = (fwk or lower or places or [_head(body)])[-1] + 1
    source.module = source.module.with_changes(body=[*body[:place], line, *body[place:]])


def _imported_from(line: cst.CSTNode) -> str | None:
    if isinstance(line, cst.SimpleStatementLine) and isinstance(line.body[0], cst.ImportFrom) and line.body[0].module:
        return dotted(line.body[0].module)
    return "" if isinstance(line, cst.SimpleStatementLine) and isinstance(line.body[0], cst.Import) else None


def _head(body: Sequence[cst.CSTNode]) -> int:
    """Returns the place of the module's docstring, or -1."""
    first = body[0] if body else None
    text = isinstance(first, cst.SimpleStatementLine) and isinstance(first.body[0], cst.Expr)
    return 0 if text else -1


def _module_name(name: str) -> cst.Name | cst.Attribute:
    parsed = cst.parse_expression(name)
    assert isinstance(parsed, cst.Name | cst.Attribute)
    return parsed
