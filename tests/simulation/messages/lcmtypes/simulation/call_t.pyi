from typing import ClassVar

from lcmtypes.core.header_t import header_t

class call_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    number: int
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> call_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
