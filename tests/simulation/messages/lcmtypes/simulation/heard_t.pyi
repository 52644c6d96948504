from typing import ClassVar


class heard_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    count: int
    first: int
    last: int
    newest: int
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> heard_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
