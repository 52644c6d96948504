from typing import ClassVar

from lcmtypes.core.answer_t import answer_t
from lcmtypes.core.header_t import header_t

class sum_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    answer: answer_t
    sum: int
    def __init__(self, *, header: header_t = ..., answer: answer_t = ..., sum: int = ...) -> None: ...
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> sum_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
