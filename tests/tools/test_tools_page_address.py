"""Address of the page of which the documentation shows a picture."""

import argparse
import socket

import pytest

from tools.docs.rerun_picture import main
from tools.docs.web_pictures import page_url, wait_for

PAGE = "http://127.0.0.1:8472/?url=rerun+http://127.0.0.1:8471/proxy"


@pytest.mark.parametrize("text", ["", "nothing", "127.0.0.1:80", "ftp://host/", "http://", "http://h:x", "http://h:0"])
def test_what_is_no_address_of_a_page_is_refused(
    text: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(argparse.ArgumentTypeError):
        page_url(text)
    monkeypatch.setattr("sys.argv", ["rerun_picture", text])
    with pytest.raises(SystemExit) as ended:
        main()
    said = f"'{text}' is not the address of a page, such as http://127.0.0.1:8460\n"
    assert (ended.value.code, capsys.readouterr().err.endswith(said)) == (2, True)


def test_addresses_of_pages_are_taken() -> None:
    for url in (PAGE, "https://robot.local", "http://[::1]:8460/view"):
        assert page_url(url) == url


def test_machine_that_cannot_be_reached_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    for host in ("no-such-machine.invalid", f"{'x' * 70}.invalid"):
        with pytest.raises(SystemExit) as ended:
            wait_for(f"http://{host}:8472/")
        said = capsys.readouterr().err
        assert (ended.value.code, said.startswith(f"error: http://{host}:8472/ cannot be reached: ")) == (2, True)


def test_absent_server_is_named_in_the_end(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        url = f"http://127.0.0.1:{listening.getsockname()[1]}/"
        wait_for(url, 1.0)
    with pytest.raises(SystemExit) as ended:
        wait_for(url, 0.2)
    said = f"error: no server listens at {url} for 0.2 s; start the one whose page is shown\n"
    assert (ended.value.code, capsys.readouterr().err) == (1, said)
