"""A scoreboard with a drawing."""


def headline(_: object) -> str:
    return "a match"


def drawing(_: object, columns: int, rows: int) -> list[list[tuple[str, str]]]:
    return [[("#" * columns, "green")] for _ in range(rows)]
