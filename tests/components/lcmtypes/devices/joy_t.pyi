from typing import ClassVar


class joy_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    utime: int
    n_axes: int
    axes: list[float]
    trigger: bool
    name: str
    def __init__(self, *, utime: int = ..., n_axes: int = ..., axes: list[float] = ..., trigger: bool = ..., name: str = ...) -> None: ...
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> joy_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
