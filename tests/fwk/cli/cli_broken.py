"""A scoreboard whose drawing fails."""


def headline(_: object) -> str:
    return "a match"


def drawing(_: object, columns: int, rows: int) -> list[list[tuple[str, str]]]:
    return [[("#" * (columns // 0), "")]]
