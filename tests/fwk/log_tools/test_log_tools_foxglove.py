"""Messages go to clients of Foxglove's protocol while they come."""

import json
import os
import struct
from collections.abc import Iterator
from typing import Any

import cv2
import numpy as np
import pytest
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from fwk.component.images import Ring
from fwk.log_tools.foxglove_server import FoxgloveServer
from fwk.log_tools.live_frames import LiveFrames
from lcmtypes.core import frame_t
from lcmtypes.robot import imu_t, odometry_t
from lcmtypes.soccer import pose_t

TIMEOUT_S = 20.0
MESSAGE_DATA = 1


class Studio:
    """A client of Foxglove's WebSocket protocol."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self.topics: dict[str, dict[str, Any]] = {}

    def wait_for(self, topic: str) -> dict[str, Any]:
        """Returns what the server says about a topic."""
        while topic not in self.topics:
            said = json.loads(self._connection.recv(TIMEOUT_S))
            if said["op"] == "advertise":
                self.topics |= {each["topic"]: each for each in said["channels"]}
        return self.topics[topic]

    def subscribe(self, number: int, topic: str) -> None:
        subscription = {"id": number, "channelId": self.wait_for(topic)["id"]}
        self._connection.send(json.dumps({"op": "subscribe", "subscriptions": [subscription]}))

    def receive(self) -> tuple[int, int, bytes] | None:
        """Returns subscription, time in ns and content of the next message; None: it has not come yet."""
        try:
            data = self._connection.recv(0.05)
        except TimeoutError:
            return None
        if isinstance(data, str) or data[0] != MESSAGE_DATA:
            return None
        return (*struct.unpack_from("<IQ", data, 1), data[13:])


@pytest.fixture
def server() -> Iterator[FoxgloveServer]:
    made = FoxgloveServer("small", 0)
    yield made
    made.close()


@pytest.fixture
def studio(server: FoxgloveServer) -> Iterator[Studio]:
    protocol = Subprotocol("foxglove.sdk.v1")
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=[protocol]) as connection:
        yield Studio(connection)


def shown(server: FoxgloveServer, studio: Studio, channel: str, message: Any, time_us: int) -> tuple[int, int, bytes]:
    """Shows a message until a subscription has begun and the message has come."""
    for _ in range(400):
        server.show(channel, message.encode(), time_us)
        if found := studio.receive():
            return found
    raise AssertionError("no message came")


def test_message_comes_as_json_with_its_schema(server: FoxgloveServer, studio: Studio) -> None:
    server.show("r/imu", imu_t().encode(), 0)
    about = studio.wait_for("r/imu")
    assert (about["schemaName"], about["encoding"]) == ("robot.imu_t", "json")
    assert "heading_rad" in json.loads(about["schema"])["properties"]
    studio.subscribe(7, "r/imu")
    subscription, time_ns, content = shown(server, studio, "r/imu", imu_t(heading_rad=1.5), 250_000)
    assert (subscription, time_ns, json.loads(content)["heading_rad"]) == (7, 250_000_000, 1.5)


def test_pose_comes_as_a_pose_of_foxglove(server: FoxgloveServer, studio: Studio) -> None:
    server.show("r/pose", pose_t(localized=True).encode(), 0)
    assert studio.wait_for("view/r/pose")["schemaName"] == "foxglove.PoseInFrame"
    studio.subscribe(1, "view/r/pose")
    assert shown(server, studio, "r/pose", pose_t(x_m=2.0, localized=True), 50_000)[1] == 50_000_000


def test_frames_come_from_the_memory_of_their_run() -> None:
    ring = Ring.create("r/image")
    pixels = np.full((12, 16, 3), 200, np.uint8)
    ring.put(1, pixels)
    announced = frame_t(frame=1, height_px=12, width_px=16, channels=3)
    server = FoxgloveServer("small", 0, LiveFrames(os.getpid()))
    protocol = Subprotocol("foxglove.sdk.v1")
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=[protocol]) as connection:
        studio = Studio(connection)
        server.show("r/image", announced.encode(), 0)
        assert studio.wait_for("view/r/image")["schemaName"] == "foxglove.CompressedImage"
        studio.subscribe(3, "view/r/image")
        _, time_ns, content = shown(server, studio, "r/image", announced, 50_000)
    server.close()
    seen = cv2.imdecode(np.frombuffer(content[content.index(b"\xff\xd8") :], np.uint8), cv2.IMREAD_COLOR)
    assert seen is not None
    assert (time_ns, seen.shape, abs(int(seen.mean()) - 200) <= 2) == (50_000_000, pixels.shape, True)


def test_frames_that_are_overwritten_or_hidden() -> None:
    ring = Ring.create("r/other")
    ring.put(5, np.zeros((12, 16), np.uint8))
    frames = LiveFrames(os.getpid())
    newest = frames.pixels("r/other", frame_t(frame=1, height_px=12, width_px=16, channels=1))
    assert newest is not None, "the announced one is overwritten"
    assert frames.pixels("r/none", frame_t(frame=1, height_px=12, width_px=16, channels=1)) is None
    assert LiveFrames(1 << 22).pixels("r/other", frame_t(frame=5, height_px=12, width_px=16, channels=1)) is None
    seen = frames.pixels("r/other", frame_t(frame=5, height_px=12, width_px=16, channels=1))
    assert seen is not None
    assert newest.shape == seen.shape == (12, 16)


def test_broken_messages_are_counted_and_left_out(server: FoxgloveServer, studio: Studio) -> None:
    server.show("r/odometry", b"garbage", 0)
    server.show("r/odometry", odometry_t().encode()[:20], 0)
    server.show("r/imu", imu_t().encode(), 0)
    studio.wait_for("r/imu")
    assert (list(studio.topics), server.undecodable) == (["r/imu"], {"r/odometry": 2})


def test_port_in_use_is_an_error(server: FoxgloveServer) -> None:
    with pytest.raises((OSError, RuntimeError)):
        FoxgloveServer("other", server.port)
