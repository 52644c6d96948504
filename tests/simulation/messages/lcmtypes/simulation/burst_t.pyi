from typing import ClassVar


class burst_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    number: int
    size: int
    ballast: bytes
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> burst_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
