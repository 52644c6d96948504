"""Rules for names of components and channels."""

import re

CHANNEL_BYTES = 63  # LCM_MAX_CHANNEL_NAME_LENGTH
RESERVED = "fwk/"
LINES = "fwk/lines"
"""Channel of log lines for components with the aspect `LogLines`."""

NOTE = "note"
"""Source file of the log lines that `fwk note` writes: the bookmarks of a recording."""

_NAME = re.compile(r"[A-Za-z_][\w-]*(/[A-Za-z_][\w-]*)*", re.ASCII)
_NAME_CHARACTERS = re.compile(r"[\w/-]+", re.ASCII)
_PATTERN = re.compile(r"(?=.*\*)[\w*-]+(/[\w*-]+)*/[A-Za-z_][\w-]*", re.ASCII)


def mistake_in(name: str) -> str:
    """Returns the mistake in the name of a component or a channel; empty if there is none.

    LCM subscribes with regular expressions, so only characters without a special meaning are allowed.
    """
    size = len(name.encode(errors="surrogatepass"))  # half a surrogate is refused below
    if size > CHANNEL_BYTES:
        return f"'{name}' has {size} bytes, LCM carries {CHANNEL_BYTES}; shorten it"
    if not _NAME.fullmatch(name):
        if name and _NAME_CHARACTERS.fullmatch(name):
            return f"'{name}' is not a valid name; each part begins with a letter or '_', such as cyan1/ball"
        return f"'{name}' is not a valid name; use letters, digits, '_', '-' and '/', such as cyan1/ball"
    if name.startswith(RESERVED):
        return f"'{name}': names that begin with '{RESERVED}' are the framework's own; take another namespace"
    return ""


def mistake_in_pattern(pattern: str) -> str:
    """Returns the mistake in the pattern of an `Each` port; empty if there is none."""
    if not _PATTERN.fullmatch(pattern):
        right = "put '*' for the namespace and a name after the last '/', such as */ball"
        return f"'{pattern}' is not a valid pattern; {right}"
    return ""
