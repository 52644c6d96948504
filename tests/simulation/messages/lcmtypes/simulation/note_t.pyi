from typing import ClassVar

from lcmtypes.core.header_t import header_t
from lcmtypes.simulation.heard_t import heard_t
from lcmtypes.simulation.taken_t import taken_t

class note_t:
    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]
    header: header_t
    iteration: int
    digest: int
    tune: int
    step: int
    asked: str
    n_heard: int
    heard: list[heard_t]
    n_taken: int
    taken: list[taken_t]
    n_told: int
    told: list[str]
    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> note_t: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...
    def get_hash(self) -> int: ...
