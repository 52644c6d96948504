from typing import ClassVar

from lcmtypes.core.command_t import command_t
from lcmtypes.core.header_t import header_t

class sum_request_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    command: command_t
    n: int
    numbers: list[int]
    def __init__(self, *, header: header_t = ..., command: command_t = ..., n: int = ..., numbers: list[int] = ...) -> None: ...
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> sum_request_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
