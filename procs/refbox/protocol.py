"""Protocol of the RefBox of the middle size league: JSON objects over TCP, each followed by a NUL byte.

`{"command": "KICKOFF", "targetTeam": "224.16.32.1"}`; a team is named by its multicast address, both teams by an empty
text. `SUBSTITUTION` and `IS_ALIVE` have the number of a robot as `robotID`; cards and `REPAIR` need none. Base stations
answer with world states (`world_state.py`). `IS_ALIVE`, by which a person asks a robot for a proof, has no other
answer, and no part in the state of the game: a server that follows a referee does not send it.
"""

import json
import re
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, NamedTuple, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator


def _possible_name(host: str) -> str:
    """Refuses a name that cannot be looked up; sockets fail at it in a way of their own."""
    try:
        host.encode("idna")
    except UnicodeError as error:
        raise ValueError(f"'{host[:_QUOTED]}' is not the name of a machine: {error}") from error
    return host


PORT = 28097
"""Port of the RefBox for base stations."""
Host = Annotated[str, Field(min_length=1, pattern=r"^[^\s\x00-\x1f]*$"), AfterValidator(_possible_name)]
"""A name or an address in the network."""
LONGEST = 65_536
"""A peer that sends more bytes without a NUL does not speak the protocol."""

_NAME = re.compile(r"[A-Za-z0-9_]{1,40}")
_NUMBER = re.compile(r"[0-9]{1,2}")
_QUOTED = 60  # characters of a peer's bytes that an error repeats


class ProtocolError(ValueError):
    """Bytes that are not a message of the RefBox."""


class Addresses(BaseModel):
    """Multicast address that names each team in commands."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    cyan: str = Field(default="224.16.32.1", min_length=1)
    magenta: str = Field(default="224.16.32.2", min_length=1)

    @model_validator(mode="after")
    def _differ(self) -> Self:
        if self.cyan == self.magenta:
            raise ValueError(f"both teams have the address {self.cyan}; give each its own")
        return self


class Command(NamedTuple):
    """A command of the RefBox."""

    name: str
    """In capitals: START, KICKOFF ..."""
    team: str = ""
    """cyan, magenta, or empty for both."""
    robot: int = 0
    """Number of the robot; 0 without one."""

    @property
    def words(self) -> str:
        """Name, team and robot for people, such as `REPAIR cyan 3`."""
        return " ".join(filter(None, (self.name, self.team, str(self.robot or ""))))


def encode(command: Command, addresses: Mapping[str, str]) -> bytes:
    """Returns the bytes of a command; `addresses` are those of the teams by name."""
    message: dict[str, Any] = {"command": command.name, "targetTeam": addresses.get(command.team, "")}
    if command.robot:
        message["robotID"] = command.robot
    return json.dumps(message).encode() + b"\0"


def parse(data: bytes) -> Any:
    """Returns the JSON value in a message without its NUL.

    Raises:
        ProtocolError: it is not JSON.
    """
    try:
        return json.loads(data, parse_constant=_refused)
    except (ValueError, RecursionError) as error:  # lists may be nested deeper than Python's stack
        raise ProtocolError(f"{data[:_QUOTED]!r} is not JSON") from error


def _refused(constant: str) -> Any:
    """Refuses NaN and infinities, which Python reads, and JSON does not know."""
    raise ValueError(f"JSON has no {constant}")


def decode(data: bytes, addresses: Mapping[str, str]) -> Command:
    """Returns the command in a message without its NUL.

    Raises:
        ProtocolError: it is not a command, or it is for a team that does not play.
    """
    message = parse(data)
    if not isinstance(message, dict) or not isinstance(message.get("command"), str):
        raise ProtocolError(f"{data[:_QUOTED]!r} has no command")
    name, address, robot = message["command"].strip(), message.get("targetTeam", ""), message.get("robotID", 0)
    if not _NAME.fullmatch(name):
        raise ProtocolError(f"{_quoted(name)} is not the name of a command")
    teams = {each: team for team, each in addresses.items()} | {"": ""}
    if not isinstance(address, str) or address not in teams:
        known = ", ".join(sorted(addresses.values()))
        raise ProtocolError(f"no team has the address {_quoted(address)}; there are {known}")
    if isinstance(robot, str) and _NUMBER.fullmatch(robot):
        robot = int(robot)
    if not isinstance(robot, int) or isinstance(robot, bool) or not 0 <= robot < 100:
        raise ProtocolError(f"{_quoted(robot)} is not the number of a robot")
    return Command(name.upper(), teams[address], robot)


def _quoted(value: object) -> str:
    """Returns the beginning of a peer's value for an error."""
    return repr(value)[:_QUOTED]


class Stream:
    """Cuts the bytes of a connection into messages."""

    def __init__(self) -> None:
        self._rest = b""
        self._drops = False  # the beginning of a message that is too long was dropped, and its end follows

    def feed(self, data: bytes) -> Iterator[bytes]:
        """Yields the messages that are complete, without their NUL.

        Raises:
            ProtocolError: a message is too long; all of it is dropped, and those before and after it are yielded first.
        """
        *whole, self._rest = (self._rest + data).split(b"\0")
        if self._drops and whole:
            del whole[0]
            self._drops = False
        yield from (message for message in whole if message.strip() and len(message) <= LONGEST)
        is_new = not self._drops and len(self._rest) > LONGEST
        self._drops |= is_new
        if self._drops:
            self._rest = b""
        if is_new or any(len(message) > LONGEST for message in whole):
            raise ProtocolError(f"more than {LONGEST} bytes without a NUL")
