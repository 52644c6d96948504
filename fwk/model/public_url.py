"""URL of the public bus: group, port and ttl of an LCM udpm bus."""

import socket
from urllib.parse import parse_qs, urlsplit


class UrlError(Exception):
    """A bus URL that cannot be used; the text names the URL and what would be right."""


def parse_url(url: str) -> tuple[str, int, int]:
    """Returns group, port and ttl of `udpm://239.255.76.67:7667?ttl=0`.

    Raises:
        UrlError: not the URL of an LCM bus.
    """
    try:
        parts = urlsplit(url)
        group, port = parts.hostname or "239.255.76.67", parts.port or 7667
        ttl = int(parse_qs(parts.query).get("ttl", ["0"])[0])
        if parts.scheme != "udpm" or not 224 <= socket.inet_aton(group)[0] <= 239 or not 0 <= ttl <= 255:
            raise ValueError
    except (ValueError, OSError) as error:
        raise UrlError(
            f"{url!r} is not an LCM bus: udpm://GROUP:PORT?ttl=N with an IPv4 multicast group, such as "
            "udpm://239.255.76.67:7667?ttl=0"
        ) from error
    return group, port, ttl
