"""World states that base stations report to a RefBox, against the members and types of the league's schema."""

import contextlib
import json
import math
import re
import socket
from collections.abc import Iterator
from typing import Any

import pytest

from fwk.testing import Bench, system_of
from lcmtypes.soccer import ball_estimate_t, game_state_t, robot_estimate_t, team_message_t, world_model_t
from procs.refbox.client import RefBoxClient
from procs.refbox.protocol import ProtocolError
from procs.refbox.server import RefBoxServer
from procs.refbox.station import Station
from procs.refbox.world_state import best_belief, check, encode, intention_of, world_state
from tests.procs.refbox.base_station import BaseStation, say

VECTORS = {"pose": 3, "targetPose": 3, "velocity": 3}
EMPTY = {"type": "worldstate", "teamName": "A", "intention": "", "robots": [], "balls": [], "obstacles": [], "ageMs": 0}


@pytest.fixture
def refbox() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(5.0)
        yield listening


def message(**values: Any) -> team_message_t:
    made = team_message_t()
    made.localized, made.number = True, 2
    for name, value in values.items():
        setattr(made, name, value)
    return made


def belief(x_m: float, y_m: float, variance_m2: float = 0.01) -> world_model_t:
    made, ball, opponent = world_model_t(), ball_estimate_t(), robot_estimate_t()
    ball.known, ball.x_m, ball.y_m, ball.vx_m_s = True, x_m, y_m, 2.0
    ball.covariance[0][0] = ball.covariance[1][1] = variance_m2
    opponent.x_m, opponent.y_m = 3.0, -1.0
    made.localized, made.ball, made.opponents = True, ball, [opponent]
    return made


def report(messages: list[team_message_t], known: world_model_t | None = None, ahead: float = 1.0) -> dict[str, Any]:
    data = encode(world_state("cyan", "attack", messages, known, ahead, 0.25, 0.05))
    assert data.endswith(b"\0")
    return check(data[:-1])


def reports_of(connection: socket.socket, count: int) -> list[dict[str, Any]]:
    data = b""
    while data.count(b"\0") < count:
        data += connection.recv(65_536)
    return [json.loads(each) for each in data.split(b"\0")[:count]]


def assert_is_of_the_schema(state: dict[str, Any]) -> None:
    """Checks the members as `MSLWMD-schema` of the RefBox lists them."""
    assert state["type"] == "worldstate"
    assert isinstance(state["teamName"], str)
    assert isinstance(state["ageMs"], int)
    for robot in state["robots"]:
        assert set(robot) <= {*VECTORS, "id", "intention", "batteryLevel", "ballEngaged"}
        assert robot["ballEngaged"] in (0, 1)
        for name, length in VECTORS.items():
            assert len(robot[name]) == length
            assert all(value is None or isinstance(value, float) for value in robot[name])
    for name, length in (("balls", 3), ("obstacles", 2)):
        for thing in state[name]:
            assert len(thing["position"]) == len(thing["velocity"]) == length
            assert 0.0 <= thing["confidence"] <= 1.0


def test_report_has_the_members_of_the_schema() -> None:
    state = report([message(battery_known=True, battery_charge=0.5, ball_held=True)], belief(1.0, 2.0))
    assert_is_of_the_schema(state)
    assert state["robots"][0]["id"] == 2
    assert state["robots"][0]["batteryLevel"] == 50.0
    assert state["robots"][0]["ballEngaged"] == 1
    assert state["obstacles"][0]["radius"] == 0.25
    assert state["ageMs"] == 50


@pytest.mark.parametrize(("ahead", "x_m", "y_m"), [(1.0, -2.0, 4.0), (-1.0, 2.0, -4.0)])
def test_y_points_to_the_goal_of_the_opponents(ahead: float, x_m: float, y_m: float) -> None:
    towards_goal_rad = 0.0 if ahead > 0 else math.pi
    robot = message(x_m=4.0, y_m=2.0, vx_m_s=ahead, heading_rad=towards_goal_rad + 0.5)
    (reported,) = report([robot], ahead=ahead)["robots"]
    assert reported["pose"] == pytest.approx([x_m, y_m, 0.5])
    assert reported["velocity"] == [0.0, 1.0, None]


def test_what_is_unknown_is_null() -> None:
    state = report([message(localized=False, x_m=3.0)])
    assert state["robots"][0]["pose"] == state["robots"][0]["targetPose"] == [None, None, None]
    assert "batteryLevel" not in state["robots"][0]
    assert state["balls"] == state["obstacles"] == []


def test_nonsense_of_a_robot_is_null() -> None:
    wrong = message(x_m=math.nan, heading_rad=math.inf, battery_known=True, battery_charge=math.nan)
    state = report([wrong], belief(math.inf, 0.0, math.nan))
    assert_is_of_the_schema(state)
    assert state["robots"][0]["pose"] == [None, None, None]
    assert state["balls"][0]["position"][:2] == [None, None]
    assert state["balls"][0]["confidence"] == 0.0


def test_the_surest_belief_is_reported() -> None:
    lost, unaware = belief(0.0, 0.0, 1e-6), belief(9.0, 9.0, 1e-6)
    lost.localized, unaware.ball.known = False, False
    surest = best_belief([lost, unaware, belief(1.0, 1.0, 0.2), belief(2.0, 2.0, 0.1)])
    assert surest is not None
    assert surest.ball.x_m == 2.0
    assert best_belief([lost]) is None


def test_confidence_falls_with_the_deviation() -> None:
    sure, unsure = (report([], belief(0.0, 0.0, sd_m**2))["balls"][0]["confidence"] for sd_m in (0.1, 1.0))
    assert sure > 0.999
    assert unsure == pytest.approx(1 - math.exp(-1 / 8))


@pytest.mark.parametrize(("holder", "words"), [("cyan2", "attack"), ("?", "defend"), ("", "win the ball")])
def test_intention_follows_the_holder_of_the_ball(holder: str, words: str) -> None:
    known = belief(0.0, 0.0)
    known.ball_holder = holder
    assert intention_of(known, ["cyan1", "cyan2"]) == words
    assert intention_of(None, ["cyan1"]) == "win the ball"


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"type": "world"}, "no JSON object with the type 'worldstate'"),
        ({"teamName": 3}, "'teamName' of its world state is missing or is not a text"),
        ({"balls": {}}, "'balls' of its world state is missing or is not a list"),
        ({"ageMs": "50"}, "'ageMs' of its world state is missing or is not a whole number"),
        ({"ageMs": True}, "'ageMs' of its world state"),
    ],
)
def test_mistake_in_a_report_is_named(wrong: dict[str, Any], reason: str) -> None:
    with pytest.raises(ProtocolError, match=reason):
        check(json.dumps(EMPTY | wrong).encode())


@pytest.mark.parametrize("data", [b"[1]", b"worldstate", b"null", b"\xff"])
def test_what_is_no_object_is_no_report(data: bytes) -> None:
    with pytest.raises(ProtocolError, match=r"is not JSON|no JSON object"):
        check(data)


def test_client_reports_the_robots_of_its_team(refbox: socket.socket) -> None:
    names = ("cyan1", "cyan2", "magenta1", "cyan3")
    bench = Bench(
        RefBoxClient, "world/refbox", namespaces=names, port=refbox.getsockname()[1], team_name="Us", report_s=0.1
    )
    bench.port("game_state").put(state=game_state_t.CORNER_KICK, cyan_side=1)
    for name in names[:3]:
        bench.port("messages", name).put(number=int(name[-1]), localized=True, x_m=1.0)
    bench.iterate(3)
    connection, _ = refbox.accept()
    with connection:
        connection.settimeout(5.0)
        bench.iterate(8)
        states = reports_of(connection, 3)
        bench.iterate(45)  # the robots are silent
        connection.setblocking(False)
        with contextlib.suppress(BlockingIOError):
            while True:
                last = connection.recv(65_536)
        bench.iterate(20)
        with pytest.raises(BlockingIOError):
            connection.recv(1)
    bench.finalize()
    assert json.loads(last.split(b"\0")[-2])["ageMs"] <= 2000
    for state in states:
        assert_is_of_the_schema(state)
        assert state["teamName"] == "Us"
        assert state["intention"] == "corner kick"
        assert [robot["id"] for robot in state["robots"]] == [1, 2]
        assert state["robots"][0]["pose"][:2] == [0.0, -1.0]  # cyan plays towards negative x


def test_reports_are_as_many_as_wanted_whatever_the_period(refbox: socket.socket) -> None:
    bench = Bench(RefBoxClient, "world/refbox", namespaces=("cyan1",), period_s=0.04, port=refbox.getsockname()[1])
    bench.iterate(2)
    connection, _ = refbox.accept()
    with connection:
        bench.port("messages", "cyan1").put(number=1)
        bench.iterate(40)  # 1.6 s
        bench.finalize()
        connection.settimeout(5.0)
        data = b""
        while more := connection.recv(65_536):
            data += more
    assert data.count(b"\0") == 16


def test_second_base_station_leaves_commands_to_the_first(refbox: socket.socket) -> None:
    bench = Bench(RefBoxClient, "world/refbox", port=refbox.getsockname()[1], obeys=False)
    bench.iterate()
    connection, _ = refbox.accept()
    with connection:
        connection.sendall(say("START") + b"?\0")
        while not any("is not JSON" in line.text for line in bench.logged):
            bench.iterate()
    bench.finalize()
    assert not bench.port("referee_command").sent


def test_client_without_reports_tells_nothing(refbox: socket.socket) -> None:
    bench = Bench(RefBoxClient, "world/refbox", namespaces=("cyan1",), port=refbox.getsockname()[1], report_s=0.0)
    bench.port("messages", "cyan1").put(number=1)
    bench.iterate(5)
    connection, _ = refbox.accept()
    with connection:
        bench.iterate(20)
        connection.setblocking(False)
        with pytest.raises(BlockingIOError):
            connection.recv(1)
    bench.finalize()


def test_refbox_that_does_not_read_gets_whole_reports(refbox: socket.socket) -> None:
    refbox.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    bench = Bench(RefBoxClient, "world/refbox", namespaces=("cyan1",), port=refbox.getsockname()[1], report_s=0.05)
    bench.iterate(2)
    connection, _ = refbox.accept()
    with connection:
        for _ in range(4000):
            bench.port("messages", "cyan1").put(number=1, intention="x" * 2000)
            bench.iterate()
        connection.settimeout(0.2)
        data = b""
        with contextlib.suppress(TimeoutError):
            while True:
                data += connection.recv(65_536)
                bench.iterate()
    bench.finalize()
    *whole, _ = data.split(b"\0")
    assert 10 < len(whole) < 4000
    assert all(check(each)["robots"][0]["intention"] == "x" * 2000 for each in whole)


def test_server_counts_reports_and_names_a_mistake() -> None:
    server = Bench(RefBoxServer, "world/refbox", port=0)
    with contextlib.closing(BaseStation(server.component.port)) as station:
        server.port("game_state").put(state=game_state_t.PLAY, half=1)
        server.iterate()
        for data in (json.dumps(EMPTY).encode(), b"{}", b"[", json.dumps(EMPTY).encode()):
            station.say(data + b"\0")
        server.iterate(2)
    server.iterate(2)
    server.finalize()
    said = [line.text.partition(" ")[2].partition(" ")[2].partition(" ")[2] for line in server.logged[1:]]
    assert said == [
        "is connected",
        "reports the world state of 'A': 0 robots, 0 balls, 0 obstacles",
        "it is no JSON object with the type 'worldstate'; refused, as further messages of this kind will be",
        "left; 2 world states reported, 2 messages refused",
    ]


def test_endless_message_of_a_station_is_dropped() -> None:
    server = Bench(RefBoxServer, "world/refbox", port=0)
    with contextlib.closing(BaseStation(server.component.port)) as station:
        server.port("game_state").put(state=game_state_t.PLAY, half=1)
        server.iterate()
        station.say(b"x" * 200_000)
        server.iterate(20)
        station.say(b"\0" + json.dumps(EMPTY).encode() + b"\0")
        server.iterate(5)
    server.iterate(2)
    server.finalize()
    assert any("more than 65536 bytes without a NUL" in line.text for line in server.logged)
    assert any("left; 1 world states reported" in line.text for line in server.logged)


def test_flood_of_a_station_is_read_in_parts() -> None:
    server = Bench(RefBoxServer, "world/refbox", port=0)
    connection, flooding = socket.socketpair()
    with connection, flooding:
        connection.setblocking(False)
        station = Station(connection, "flooding", server.component.log)
        flooding.sendall(b"1\0" * 1000 + json.dumps(EMPTY).encode() + b"\0")
        assert station.hear()
        assert 0 < station.refused <= 100
        assert all(station.hear() for _ in range(15))
        assert (station.refused, station.reports) == (1000, 1)
        flooding.close()
        assert not station.hear()
    server.finalize()


@pytest.mark.slow
def test_match_of_the_launch_file_is_reported(refbox: socket.socket) -> None:
    system = system_of("soccer-refbox.yaml", sets=[f"world/refbox.port={refbox.getsockname()[1]}"])
    system.tick(2)
    connection, _ = refbox.accept()
    data = b""
    with connection:
        connection.setblocking(False)
        for _ in range(120):
            system.tick()
            with contextlib.suppress(BlockingIOError):
                data += connection.recv(65_536)
    system.runners["world/refbox"].component.finalize()
    states = [json.loads(each) for each in data.split(b"\0")[:-1]]
    assert len(states) > 30
    for state in states:
        assert_is_of_the_schema(state)
    last = states[-1]
    assert [robot["id"] for robot in last["robots"]] == [1, 2, 3, 4, 5]
    assert all(robot["pose"][1] < 0.5 for robot in last["robots"])  # in the own half before the kick-off
    assert last["balls"][0]["position"] == pytest.approx([0.0, 0.0, 0.0], abs=0.3)
    assert last["balls"][0]["confidence"] > 0.9


def test_half_closed_station_is_heard_and_still_told() -> None:
    server = Bench(RefBoxServer, "world/refbox", port=0)
    with contextlib.closing(BaseStation(server.component.port)) as station:
        station.say(json.dumps(EMPTY).encode() + b"\0" + b"{")
        station.end()
        server.port("game_state").put(state=game_state_t.PLAY, half=1)
        server.iterate(4)
        assert any("reports the world state of 'A'" in line.text for line in server.logged)
        server.port("game_state").put(state=game_state_t.DROP_BALL, half=1, stopped=True)
        server.iterate()
        assert [each["command"] for each in station.heard(6)][-2:] == ["STOP", "DROP_BALL"]
    for stopped in (False, True, False, True):
        server.port("game_state").put(state=game_state_t.DROP_BALL, half=1, stopped=stopped)
        server.iterate()
    server.finalize()
    assert any("1 world states reported, 0 messages refused" in line.text for line in server.logged)


def test_half_closed_station_makes_room_for_another() -> None:
    server = Bench(RefBoxServer, "world/refbox", port=0, stations=1)
    with contextlib.closing(BaseStation(server.component.port)) as silent:
        silent.end()
        server.port("game_state").put(state=game_state_t.PLAY, half=1)
        server.iterate(2)
        with contextlib.closing(BaseStation(server.component.port)) as station:
            server.iterate()
            assert station.heard(1)[0]["command"] == "WELCOME"
    server.finalize()


@pytest.mark.parametrize("obeys", [True, False])
def test_signs_of_life_are_those_of_the_own_robots(refbox: socket.socket, obeys: bool) -> None:
    names, port = ("cyan1", "cyan2", "magenta1"), refbox.getsockname()[1]
    bench = Bench(RefBoxClient, "world/refbox", namespaces=names, port=port, obeys=obeys, report_s=0.0)
    bench.iterate()
    bench.port("messages", "cyan2").put(number=2)
    connection, _ = refbox.accept()
    with connection:
        bench.iterate(20)  # at 20 Hz
        asked = [("224.16.32.1", 3), ("224.16.32.2", 1), ("224.16.32.1", 2), ("224.16.32.1", 2), ("", 1)]
        connection.sendall(b"".join(say("IS_ALIVE", team, robotID=number) for team, number in asked))
        for _ in range(100):
            bench.iterate()
            if len(bench.logged) > 1:
                break
        bench.iterate(5)
    bench.finalize()
    (said,) = [line.text for line in bench.logged if "signs of life" in line.text]
    assert re.fullmatch(
        r"the RefBox asks for signs of life: cyan2 told something [1-6]\.\d s ago, cyan3 has told nothing", said
    )
    assert bench.port("referee_command").sent == []
