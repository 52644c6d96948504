"""Names that are right in the place of an unknown one."""

from collections.abc import Iterable
from difflib import get_close_matches


def right_name(word: str, known: Iterable[str]) -> str:
    """Returns what would be right in the place of an unknown word: the nearest known word, or all of them.

    A word in other capitals is near, too, such as KICKOFF of a RefBox.
    """
    names = list(known)
    near = get_close_matches(word, names, 1) or get_close_matches(word.lower(), names, 1)
    return f"did you mean '{near[0]}'?" if near else f"there are {', '.join(names) or 'none'}"
