from typing import ClassVar

from lcmtypes.core.command_t import command_t
from lcmtypes.core.header_t import header_t

class lift_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    command: command_t
    height_m: float
    def __init__(self, *, header: header_t = ..., command: command_t = ..., height_m: float = ...) -> None: ...
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> lift_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
