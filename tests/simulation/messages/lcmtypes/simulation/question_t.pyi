from typing import ClassVar

from lcmtypes.core.command_t import command_t
from lcmtypes.core.header_t import header_t

class question_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    command: command_t
    number: int
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> question_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
