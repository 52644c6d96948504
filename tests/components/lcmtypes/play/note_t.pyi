from typing import ClassVar

from lcmtypes.core.header_t import header_t
from lcmtypes.play.heard_t import heard_t

class note_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    iterations: int
    digest: int
    frozen: bool
    n: int
    heard: list[heard_t]
    def __init__(self, *, header: header_t = ..., iterations: int = ..., digest: int = ..., frozen: bool = ..., n: int = ..., heard: list[heard_t] = ...) -> None: ...
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> note_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
