from typing import ClassVar


class heard_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    channel: str
    first: int
    last: int
    count: int
    newest_tick: int
    newest_stage: int
    def __init__(self, *, channel: str = ..., first: int = ..., last: int = ..., count: int = ..., newest_tick: int = ..., newest_stage: int = ...) -> None: ...
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> heard_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
