"""Records camera frames without loss in the order of the log, compressed by other threads."""

from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path

from fwk.component.images import Frame, Ring, shape_of
from fwk.lcm import messages
from fwk.model.plan import Plan
from fwk.recording.pictures import FRAME, compressed
from fwk.recording.sinks import Recorder
from lcmtypes.core import frame_t, picture_t

WAITING_BYTES = 128 << 20  # frames that are not compressed yet
_THREADS = 2


class FrameRecorder(Recorder):
    """Recorder that writes each frame of `rings` before its announcement.

    Messages after a frame wait until it is compressed, so the order of the log does not depend on the time that takes.
    If too much waits, lockstep waits too; in real time the frame is left out.
    """

    def __init__(self, plan: Plan, path: Path, rings: Mapping[str, Ring], report: Callable[[str], None]) -> None:
        super().__init__(plan, path, report)
        self._rings = rings
        self._may_wait = plan.clock == "simulated"
        self._pool = ThreadPoolExecutor(_THREADS, "frames")
        self._waiting: deque[tuple[str, Future[bytes] | bytes, int, int]] = deque()  # the last: bytes of the frame
        self._waiting_bytes = 0
        self._left_out: dict[tuple[str, str], int] = {}

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Adds a message, preceded by the frame that it announces."""
        if channel in self._rings:
            self._frame(channel, messages.decode(frame_t, data, channel), time_us)
        if self._waiting:
            self._waiting.append((channel, data, time_us, 0))
        else:
            super().message(channel, data, time_us)

    def tick(self) -> None:
        """Writes the frames that are compressed, and the messages after them."""
        self._write_ready()
        super().tick()

    def close(self) -> None:
        """Compresses the remaining frames and finishes the log."""
        while self._waiting:
            self._write_oldest()
        self._pool.shutdown()
        super().close()
        for (channel, why), count in self._left_out.items():
            self._report(f"{channel}: {count} frames are not in the recording: {why}")

    def _frame(self, channel: str, frame: frame_t, time_us: int) -> None:
        size = frame.height_px * frame.width_px * frame.channels
        while self._may_wait and self._waiting and self._waiting_bytes + size > WAITING_BYTES:
            self._write_oldest()
        if self._waiting_bytes + size > WAITING_BYTES and self._waiting:
            self._leave_out(channel, frame, "they come faster than they can be compressed")
            return
        pixels = self._rings[channel].get(frame.frame, size)
        if pixels is None:
            self._leave_out(channel, frame, "the camera had overwritten them")
            return
        shape = shape_of(frame.height_px, frame.width_px, frame.channels)
        work = partial(_picture, channel, frame, pixels.reshape(shape))
        self._waiting.append((FRAME, self._pool.submit(work), time_us, size))
        self._waiting_bytes += size

    def _leave_out(self, channel: str, frame: frame_t, why: str) -> None:
        count = self._left_out[channel, why] = self._left_out.get((channel, why), 0) + 1
        if str(count).strip("0") == "1":
            self._report(f"{channel}: frame {frame.frame} is not in the recording: {why} ({count} so far)")

    def _write_ready(self) -> None:
        while self._waiting:
            data = self._waiting[0][1]
            if isinstance(data, Future) and not data.done():
                return
            self._write_oldest()

    def _write_oldest(self) -> None:
        channel, data, time_us, size = self._waiting.popleft()
        self._waiting_bytes -= size
        super().message(channel, data.result() if isinstance(data, Future) else data, time_us)


def _picture(channel: str, frame: frame_t, pixels: Frame) -> bytes:
    made = picture_t()
    made.header, made.camera, made.frame = frame.header, channel, frame.frame
    made.height_px, made.width_px, made.channels = frame.height_px, frame.width_px, frame.channels
    made.format, made.data = compressed(pixels)
    made.n = len(made.data)
    return bytes(made.encode())
