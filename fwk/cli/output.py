"""Output of the commands: lines and tables."""

from fwk.display.table import Table, has_colour, terminal_width


def say(*lines: str) -> None:
    """Prints lines."""
    for line in lines:
        print(line)


def say_table(table: Table) -> None:
    """Prints a table as wide as the terminal, or in full to a file or pipe."""
    say(*table.lines(terminal_width(), has_colour()))
