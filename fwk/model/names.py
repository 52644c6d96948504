"""Which names components and channels may have."""

import re

CHANNEL_BYTES = 63  # LCM_MAX_CHANNEL_NAME_LENGTH
RESERVED = "fwk/"
LINES = "fwk/lines"
"""The channel on which the gateway gives lines of text to components that are targets of the log."""

_NAME = re.compile(r"[A-Za-z_][\w-]*(/[A-Za-z_][\w-]*)*", re.ASCII)
_PATTERN = re.compile(r"(?=.*\*)[\w*-]+(/[\w*-]+)*/[A-Za-z_][\w-]*", re.ASCII)


def mistake_in(name: str) -> str:
    """What is wrong with the name of a component or a channel; empty if nothing.

    LCM takes a channel name as a regular expression when somebody subscribes, so only characters without a meaning
    there are allowed.
    """
    size = len(name.encode(errors="surrogatepass"))  # half a surrogate is refused below
    if size > CHANNEL_BYTES:
        return f"'{name}' has {size} bytes, LCM carries {CHANNEL_BYTES}; shorten it"
    if not _NAME.fullmatch(name):
        return f"'{name}' is not a valid name; use letters, digits, '_', '-' and '/', such as cyan1/ball"
    if name.startswith(RESERVED):
        return f"'{name}': names that begin with '{RESERVED}' are the framework's own; take another namespace"
    return ""


def mistake_in_pattern(pattern: str) -> str:
    """What is wrong with the pattern of a port of many instances; empty if nothing."""
    if not _PATTERN.fullmatch(pattern):
        right = "put '*' for the namespace and a name after the last '/', such as */ball"
        return f"'{pattern}' is not a valid pattern; {right}"
    return ""
