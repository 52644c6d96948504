from typing import ClassVar

from lcmtypes.core.answer_t import answer_t
from lcmtypes.core.header_t import header_t

class reply_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    answer: answer_t
    number: int
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> reply_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
