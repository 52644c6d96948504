from typing import ClassVar


class taken_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    kind: str
    sender: str
    sequence: int
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> taken_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
