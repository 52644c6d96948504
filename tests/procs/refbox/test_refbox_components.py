"""RefBox server and client over TCP, with the other side written from the protocol's description."""

import contextlib
import socket
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from pydantic import ValidationError

from fwk import Config
from fwk.testing import Bench, MemorySystem
from lcmtypes.soccer import game_event_t, game_state_t, true_robot_t
from procs.refbox.client import ClientConfig, RefBoxClient
from procs.refbox.server import RefBoxServer, ServerConfig
from procs.referee.referee import Referee
from procs.simulation.simulator import Simulator
from tests.procs.refbox.base_station import BaseStation, say

CYAN, MAGENTA = "224.16.32.1", "224.16.32.2"


@pytest.fixture
def server() -> Iterator[Bench]:
    bench = Bench(RefBoxServer, "world/refbox", port=0)
    yield bench
    bench.finalize()


@pytest.fixture
def refbox() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(5.0)
        yield listening


def show(bench: Bench, kind: int, team: int, stopped: bool) -> None:
    bench.port("game_state").put(state=kind, state_team=team, stopped=stopped, half=1)
    bench.iterate()


def names(messages: list[dict[str, Any]]) -> list[tuple[str, str]]:
    return [(message["command"], message["targetTeam"]) for message in messages]


def test_base_station_hears_where_the_game_is_and_what_follows(server: Bench) -> None:
    with contextlib.closing(BaseStation(server.component.port)) as station:
        show(server, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, True)
        assert names(station.heard(4)) == [("WELCOME", ""), ("RESET", ""), ("FIRST_HALF", ""), ("KICKOFF", CYAN)]
        show(server, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, False)
        show(server, game_state_t.PLAY, game_state_t.TEAM_NONE, False)
        show(server, game_state_t.CORNER_KICK, game_state_t.TEAM_MAGENTA, True)
        assert names(station.heard(3)) == [("START", ""), ("STOP", ""), ("CORNER", MAGENTA)]


def test_base_station_that_has_left_does_not_matter(server: Bench) -> None:
    gone = BaseStation(server.component.port)
    show(server, game_state_t.PLAY, 0, False)
    gone.close()
    with contextlib.closing(BaseStation(server.component.port)) as station:
        for stopped in (True, False, True, False):
            show(server, game_state_t.DROP_BALL, 0, stopped)
        assert names(station.heard(3))[0] == ("WELCOME", "")


def test_server_forgets_stations_that_come_and_go(server: Bench) -> None:
    for _ in range(60):
        show(server, game_state_t.PLAY, 0, False)
        BaseStation(server.component.port).close()
    show(server, game_state_t.PLAY, 0, False)
    show(server, game_state_t.PLAY, 0, False)
    assert sum(" left; 0 world states reported, 0 " in line.text for line in server.logged) >= 59


def test_server_turns_away_more_stations_than_it_serves() -> None:
    bench = Bench(RefBoxServer, "world/refbox", port=0, stations=2)
    with contextlib.ExitStack() as open_until_the_end:
        open_until_the_end.callback(bench.finalize)
        stations = [BaseStation(bench.component.port) for _ in range(3)]
        for each in stations:
            open_until_the_end.enter_context(contextlib.closing(each))
        show(bench, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, True)
        show(bench, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, False)
        assert [len(each.heard(5)) for each in stations[:2]] == [5, 5]
        with pytest.raises(AssertionError, match="closed the connection"):
            stations[2].heard(1)
        assert any("is turned away: 2 are connected" in line.text for line in bench.logged)


def test_server_is_deaf_to_what_stations_say(server: Bench) -> None:
    with contextlib.closing(BaseStation(server.component.port)) as station:
        show(server, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, True)
        station.say(b"\0\xff[[[{" * 20_000)
        show(server, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, False)
        assert names(station.heard(5))[-1] == ("START", "")


def test_client_leads_the_referee(refbox: socket.socket) -> None:
    system = MemorySystem(
        {
            "world/refbox": RefBoxClient,
            "world/referee": Referee,
            "world/simulator": Simulator,
        },
        settings={"world/refbox": {"port": refbox.getsockname()[1]}, "world/referee": {"automatic": False}},
    )
    system.tick()
    connection, _ = refbox.accept()
    with connection:
        states = []
        for command, team in (("STOP", ""), ("CORNER", MAGENTA), ("START", ""), ("GOAL", CYAN), ("GAMEOVER", "")):
            connection.sendall(say(command, team))
            for _ in range(40):
                before = len(system.sent["world/referee_command@world/refbox"])
                system.tick()
                if len(system.sent["world/referee_command@world/refbox"]) > before:
                    break
            system.tick(2)
            game = system.newest("world/game_state")
            states.append((game.state, game.state_team, game.stopped, game.score_cyan))
    system.runners["world/refbox"].component.finalize()
    corner = game_state_t.CORNER_KICK
    assert states[1:] == [(corner, 2, True, 0), (corner, 2, False, 0), (2, 2, True, 1), (0, 0, True, 1)]


@pytest.mark.parametrize(
    ("command", "told"),
    [
        ({"name": "substitution", "robot": "magenta3"}, [("SUBSTITUTION", MAGENTA, 3)]),
        ({"name": "repair", "robot": "cyan2"}, [("REPAIR", CYAN, 2)]),
        ({"name": "red_card", "robot": "cyan2"}, [("RED_CARD", CYAN, 2)]),
        ({"name": "park"}, [("PARK", "", None)]),
        ({"name": "reset"}, [("RESET", "", None), ("FIRST_HALF", "", None), ("KICKOFF", CYAN, None)]),
    ],
)
@pytest.mark.parametrize("in_break", [False, True])
def test_command_by_hand_is_told_by_its_name(
    command: dict[str, str], told: list[tuple[str, str, int | None]], in_break: bool
) -> None:
    referee, server = Bench(Referee, "world/referee"), Bench(RefBoxServer, "world/refbox", port=0)

    def tick(**asked: str) -> None:
        if asked:
            referee.port("referee_command").put(**asked)
        referee.port("ground_truth").put(robots=[true_robot_t(name=name) for name in ("cyan2", "magenta3")])
        referee.iterate()
        server.port("match_history").put(referee.port("match_history").sent[-1])
        server.port("game_state").put(referee.port("game_state").sent[-1])
        server.iterate()

    with contextlib.closing(BaseStation(server.component.port)) as station:
        for _ in range(3):
            tick()
        station.heard(4)
        if in_break:
            tick(name="half_time")
            station.heard(2)
        tick(**command)
        tick()
        tick(name="end_game")
        heard = [(each["command"], each["targetTeam"], each.get("robotID")) for each in station.heard(len(told) + 2)]
        assert heard == [*told, ("STOP", "", None), ("END_GAME", "", None)]
    server.finalize()


def test_client_tries_again_and_says_once_why() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        free = taken.getsockname()[1]
    bench = Bench(RefBoxClient, "world/refbox", port=free, retry_s=0.2)
    for _ in range(2):  # the second time after a RefBox that has ended
        bench.iterate(15)
        with socket.create_server(("127.0.0.1", free)) as late:
            late.settimeout(5.0)
            bench.iterate(10)
            late.accept()[0].close()
        bench.iterate(2)
    bench.finalize()
    said = [line.text for line in bench.logged]
    refused = f"no RefBox at 127.0.0.1:{free}: Connection refused; it is tried again every 0.2 s"
    found = [f"connected with the RefBox at 127.0.0.1:{free}", "lost the RefBox: it closed the connection"]
    assert said == [refused, *found] * 2


def test_silent_name_server_holds_nothing_up(refbox: socket.socket, monkeypatch: pytest.MonkeyPatch) -> None:
    """The lookup of a name takes as long as the name server likes; ticks go on meanwhile."""
    answered, looked_up, ask = threading.Event(), threading.Event(), socket.getaddrinfo

    def slow(host: str, port: int, **how: Any) -> Any:
        if how["flags"] & socket.AI_NUMERICHOST:
            return ask(host, port, **how)
        answered.wait(10.0)
        found = ask("127.0.0.1", port, **how)
        looked_up.set()
        return found

    monkeypatch.setattr(socket, "getaddrinfo", slow)
    port = refbox.getsockname()[1]
    bench = Bench(RefBoxClient, "world/refbox", host="refbox.example", port=port, retry_s=0.2, connect_s=0.5)
    bench.iterate(30)
    assert not answered.is_set()
    answered.set()
    assert looked_up.wait(10.0)
    while not any("connected" in line.text for line in bench.logged):
        bench.iterate()
    refbox.accept()[0].close()
    bench.finalize()
    where = f"RefBox at refbox.example:{port}"
    late = f"no {where}: no address of that name for 0.5 s; it is tried again every 0.2 s"
    assert [line.text for line in bench.logged] == [late, f"connected with the {where}"]


def test_client_goes_to_a_new_address_at_once(refbox: socket.socket) -> None:
    bench = Bench(RefBoxClient, "world/refbox", port=refbox.getsockname()[1])
    bench.iterate(2)
    former, _ = refbox.accept()
    with former, socket.create_server(("127.0.0.1", 0)) as new:
        new.settimeout(5.0)
        former.settimeout(5.0)
        bench.component.config = ClientConfig(port=new.getsockname()[1])
        bench.iterate(2)
        new.accept()[0].close()
        assert former.recv(1) == b""
    bench.finalize()


def test_refbox_that_does_not_answer_holds_nothing_up(refbox: socket.socket) -> None:
    refbox.listen(0)
    with contextlib.ExitStack() as waiting:  # a full queue: the next connection is not answered
        for _ in range(4):
            other = waiting.enter_context(socket.socket())
            other.setblocking(False)
            other.connect_ex(refbox.getsockname())
        bench = Bench(RefBoxClient, "world/refbox", port=refbox.getsockname()[1], connect_s=0.3)
        waiting.callback(bench.finalize)
        bench.iterate()
        assert not bench.logged  # it has not waited
        bench.iterate(8)
        assert any("no answer for 0.3 s" in line.text for line in bench.logged)


def test_nonsense_of_a_refbox_is_named(refbox: socket.socket) -> None:
    bench = Bench(RefBoxClient, "world/refbox", port=refbox.getsockname()[1])
    bench.iterate()
    connection, _ = refbox.accept()
    with connection:
        connection.sendall(b"hello\0" + b"?\0" * 500)
        for _ in range(100):
            bench.iterate()
            if any(line.text == "RefBox: b'?' is not JSON" for line in bench.logged):
                break
    assert [line.text for line in bench.logged if "RefBox:" in line.text] == [
        "RefBox: b'hello' is not JSON (and 99 more)",
        *["RefBox: b'?' is not JSON (and 99 more)"] * 4,
        "RefBox: b'?' is not JSON",
    ]
    bench.finalize()


def led(refbox: socket.socket) -> tuple[MemorySystem, socket.socket]:
    """Returns a referee that a RefBox alone leads, and the RefBox's side of the connection."""
    components = {"world/refbox": RefBoxClient, "world/referee": Referee, "world/simulator": Simulator}
    settings = {"world/refbox": {"port": refbox.getsockname()[1]}, "world/referee": {"automatic": False}}
    system = MemorySystem(components, settings=settings)
    system.tick()
    return system, refbox.accept()[0]


def test_command_behind_a_flood_is_obeyed(refbox: socket.socket) -> None:
    system, connection = led(refbox)
    with connection:
        connection.sendall(b"?\0" * 2000 + say("CORNER", CYAN))
        for _ in range(100):
            system.tick()
            if system.newest("world/game_state").state == game_state_t.CORNER_KICK:
                break
    system.runners["world/refbox"].component.finalize()
    assert system.newest("world/game_state").state == game_state_t.CORNER_KICK
    assert not [line.text for line in system.logged if "lost the RefBox" in line.text]


def test_commands_that_arrive_at_once_are_all_obeyed(refbox: socket.socket) -> None:
    """A late station gets so many commands; they are more than may wait for the referee."""
    system, connection = led(refbox)
    with connection:
        connection.sendall(say("GOAL", CYAN) * 90 + say("GOAL", MAGENTA) * 80)
        for _ in range(100):
            system.tick()
            if system.newest("world/game_state").score_magenta == 80:
                break
    system.runners["world/refbox"].component.finalize()
    game = system.newest("world/game_state")
    assert (game.score_cyan, game.score_magenta) == (90, 80)


def test_refused_commands_of_a_tick_are_one_line(refbox: socket.socket) -> None:
    components = {"world/refbox": RefBoxClient, "world/referee": Referee, "world/simulator": Simulator}
    system = MemorySystem(components, settings={"world/refbox": {"port": refbox.getsockname()[1]}})
    system.tick()
    connection, _ = refbox.accept()
    with connection:
        connection.sendall(say("SUBGOAL", CYAN) * 500)
        for _ in range(100):
            system.tick()
            if any("does not obey" in line.text for line in system.logged):
                break
        system.tick(20)
    system.runners["world/refbox"].component.finalize()
    lines = [line.text for line in system.logged if "does not obey" in line.text]
    assert len(lines) < 10
    assert any(line.endswith(" more)") for line in lines)


def test_server_listens_on_an_ipv6_address(leave_out: Callable[[str], None]) -> None:
    try:
        socket.create_server(("::1", 0), family=socket.AF_INET6).close()
    except OSError:
        leave_out("needs IPv6 addresses, which the machine lacks")
    bench = Bench(RefBoxServer, "world/refbox", host="::1", port=0)
    with contextlib.closing(socket.create_connection(("::1", bench.component.port), timeout=5.0)) as station:
        show(bench, game_state_t.KICK_OFF, game_state_t.TEAM_CYAN, True)
        assert b"WELCOME" in station.recv(4096)
    bench.finalize()


@pytest.mark.parametrize("settings", [ClientConfig, ServerConfig])
@pytest.mark.parametrize("host", ["", "127.0.0.1\0", "a b", "there\n", "ö" * 70, "a..b"])
def test_host_that_is_no_name_is_refused(settings: type[Config], host: str) -> None:
    with pytest.raises(ValidationError, match="host"):
        settings.model_validate({"host": host})


@pytest.mark.parametrize("settings", [ClientConfig, ServerConfig])
def test_settings_with_one_address_keep_the_other(settings: type[ClientConfig | ServerConfig]) -> None:
    addresses = settings.model_validate({"addresses": {"cyan": "224.16.32.9"}}).addresses
    assert (addresses.cyan, addresses.magenta) == ("224.16.32.9", MAGENTA)


def test_robots_have_the_numbers_of_the_players(refbox: socket.socket) -> None:
    players = {"anna": {"team": "magenta", "number": 7}}
    bench = Bench(RefBoxClient, "world/refbox", port=refbox.getsockname()[1], players=players)
    bench.iterate()
    connection, _ = refbox.accept()
    with connection:
        connection.sendall(say("REPAIR", MAGENTA, robotID=7) + say("REPAIR", CYAN, robotID=7))
        connection.sendall(say("CORNER", CYAN, robotID=7))
        while len(bench.port("referee_command").sent) < 3:
            bench.iterate()
    bench.finalize()
    robots = [each.robot for each in bench.port("referee_command").sent]
    assert robots == ["anna", "cyan7", ""], "a corner kick has no robot"


def test_card_is_sent_with_the_number_of_the_player() -> None:
    bench = Bench(RefBoxServer, "world/refbox", port=0, players={"anna": {"team": "magenta", "number": 7}})
    with contextlib.closing(BaseStation(bench.component.port)) as station:
        show(bench, game_state_t.PLAY, 0, False)
        card = game_event_t()
        card.card, card.team, card.robot = game_event_t.RED, game_state_t.TEAM_MAGENTA, "anna"
        bench.port("match_history").put(events=[card])
        for kind in (game_state_t.PLAY, game_state_t.PLAY, game_state_t.HALF_TIME):  # one new event
            bench.port("game_state").put(state=kind, half=1, decisions=1)
            bench.iterate()
        heard = station.heard(7)[4:]
        assert heard[0] == {"command": "RED_CARD", "targetTeam": MAGENTA, "robotID": 7}
        assert [each["command"] for each in heard] == ["RED_CARD", "STOP", "HALF_TIME"]
    bench.finalize()


def test_newcomer_hears_of_score_break_and_players() -> None:
    bench = Bench(RefBoxServer, "world/refbox", port=0, players={"anna": {"team": "magenta", "number": 7}})
    with contextlib.closing(BaseStation(bench.component.port)) as station:
        bench.port("game_state").put(
            state=game_state_t.HALF_TIME, half=1, stopped=True, score_cyan=1, n_sent_off=1, sent_off=["anna"]
        )
        bench.iterate()
        heard = station.heard(7)
        told = ["WELCOME", "RESET", "FIRST_HALF", "GOAL", "REPAIR", "STOP", "HALF_TIME"]
        assert [each["command"] for each in heard] == told
        assert heard[4] == {"command": "REPAIR", "targetTeam": MAGENTA, "robotID": 7}
    bench.finalize()
