"""`fwk cam` shows any bytes as a picture or reports that the picture is damaged."""

from pathlib import Path
from zlib import crc32

import cv2
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as some
from typer.testing import CliRunner

from fwk.cli.commands import app as fwk
from fwk.lcm.event_log import LogWriter
from lcmtypes.core import picture_t
from tests.harness.fuzz import damaged

PIXELS = np.random.default_rng(1).integers(0, 256, (12, 16, 3), np.uint8)


def encoded(kind: str) -> bytes:
    return cv2.imencode(f".{kind}", PIXELS)[1].tobytes()


def message(kind: str, data: bytes) -> bytes:
    made = picture_t()
    made.camera, made.frame, made.format, made.data, made.n = "cyan1/image", 1, kind, data, len(data)
    return made.encode()


def check(folder: Path, picture: bytes) -> None:
    with LogWriter(folder / "log.lcm", print) as log:
        log.append("world/pictures", picture, 0)
    for options in ([], ["cyan1/image", "--save", str(folder / "one.png")], ["cyan1/image", "--save", str(folder)]):
        shown = CliRunner().invoke(fwk, ["cam", "--log", str(folder / "log.lcm"), *options])
        assert shown.exception is None or isinstance(shown.exception, SystemExit), (picture, shown.exception)


@pytest.mark.parametrize("kind", ["png", "jpeg"])
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(some.data())
def test_a_damaged_picture_is_decoded_or_refused(tmp_path: Path, kind: str, data: some.DataObject) -> None:
    check(tmp_path, message(kind, data.draw(damaged(encoded(kind)))))


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(some.data())
def test_a_damaged_picture_message_is_decoded_or_refused(tmp_path: Path, data: some.DataObject) -> None:
    check(tmp_path, data.draw(damaged(message("png", encoded("png")))))


@pytest.mark.parametrize("size", [(1 << 31) - 1, 1 << 20, 1 << 16])
def test_a_picture_of_huge_claimed_size_is_refused(tmp_path: Path, size: int) -> None:
    png = bytearray(encoded("png"))
    png[16:24] = size.to_bytes(4) * 2
    png[29:33] = crc32(png[12:29]).to_bytes(4)
    check(tmp_path, message("png", bytes(png)))
