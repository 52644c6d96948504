"""Seeds that a command line names."""

import argparse
import re

MOST = 100_000
"""Seeds of one command: what is known of each is kept in memory."""


def seeds_of(text: str) -> range:
    """Returns the seeds `1..4`, or the one `7`.

    Raises:
        ValueError: the text is neither, or there are too many.
    """
    words = re.fullmatch(r"(\d{1,30})(?:\.\.(\d{1,30}))?", text.strip(), re.ASCII)
    first, last = (int(words[1]), int(words[2] or words[1])) if words else (1, 0)
    if first > last:
        raise ValueError(f"'{text}' is not a range of seeds; use 1..20, or 7")
    if last - first >= MOST:
        raise ValueError(f"'{text}' is too many; use {MOST:,} seeds at most")
    return range(first, last + 1)


def seed_argument(text: str) -> int:
    """Returns the seed of a command line that `argparse` reads.

    Raises:
        ArgumentTypeError: the text is no whole number from 0.
    """
    if not (text.isascii() and text.isdecimal()):
        raise argparse.ArgumentTypeError(f"'{text}' is not a seed; use a whole number from 0")
    return int(text)
