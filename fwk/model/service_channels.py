"""Names of the channels of services: `SERVICE@CLIENT` has a client's requests, `SERVICE@answers` the answers to all."""

ANSWERS = "answers"
"""Takes the place of the client in the name of the channel of answers."""
OUTSIDE = "outside"
"""All tools together as one client; their requests come through the control socket."""
_MARK = "@"


def service_channel(service: str, client: str) -> str:
    """Returns the channel of a client's requests; of the answers, if `client` is `ANSWERS`."""
    return f"{service}{_MARK}{client}"


def is_of_service(channel: str) -> bool:
    """Returns whether a channel carries requests or answers."""
    return _MARK in channel


def service_of(channel: str) -> str:
    """Returns the service whose requests or answers a channel carries; of any other channel its name."""
    return channel.partition(_MARK)[0]


def client_of(channel: str) -> str:
    """Returns the client whose requests a channel carries, or `ANSWERS`; empty for any other channel."""
    return channel.partition(_MARK)[2]
