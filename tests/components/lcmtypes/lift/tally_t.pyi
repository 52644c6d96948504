from typing import ClassVar

from lcmtypes.core.header_t import header_t

class tally_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    sent: int
    done: int
    ended: int
    sum: int
    n: int
    reasons: list[str]
    def __init__(self, *, header: header_t = ..., sent: int = ..., done: int = ..., ended: int = ..., sum: int = ..., n: int = ..., reasons: list[str] = ...) -> None: ...
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> tally_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
