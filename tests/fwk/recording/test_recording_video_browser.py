"""Videos play in a browser: headless Chromium loads a page with the video and reports how far it played."""

import http.server
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NoReturn
from urllib.parse import unquote

import numpy as np
import pytest

from fwk.recording.video_encoder import open_encoder

BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
OPTIONS = ("--headless", "--no-sandbox", "--disable-gpu", "--autoplay-policy=no-user-gesture-required")
WAIT_S = 60.0
PICTURES, PER_S = 20, 20.0
PAGE = b"""<video id="video" muted autoplay src="video.mp4"></video>
<script>
  const video = document.getElementById("video");
  const report = text => fetch("/report/" + encodeURIComponent(text));
  video.onended = () => report(`${video.videoWidth}x${video.videoHeight} until ${video.currentTime.toFixed(1)} s`);
  video.onerror = () => report("refused: " + video.error.message);
</script>"""

pytestmark = pytest.mark.slow


class Site(http.server.ThreadingHTTPServer):
    """Serves the page and a video; collects what the page reports."""

    def __init__(self, video: Path) -> None:
        super().__init__(("127.0.0.1", 0), Handler)
        self.video = video
        self.reports: queue.Queue[str] = queue.Queue()


class Handler(http.server.BaseHTTPRequestHandler):
    server: Site

    def do_GET(self) -> None:
        if self.path.startswith("/report/"):
            self.server.reports.put(unquote(self.path.removeprefix("/report/")))
        video = self.path == "/video.mp4"
        self.send_response(200)
        self.send_header("Content-Type", "video/mp4" if video else "text/html")
        self.end_headers()
        self.wfile.write(self.server.video.read_bytes() if video else PAGE)

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    with Site(tmp_path / "video.mp4") as site:
        thread = threading.Thread(target=site.serve_forever)
        thread.start()
        yield site
        site.shutdown()
        thread.join()


@pytest.fixture
def browser(leave_out: Callable[[str], NoReturn]) -> str:
    """The path of a browser."""
    return next(filter(None, map(shutil.which, BROWSERS)), None) or leave_out(f"needs {BROWSERS[0]}, to play videos")


@pytest.mark.parametrize(("library", "codec"), [("PyAV", "H.264"), ("OpenCV", "VP9")])
def test_a_browser_plays_the_video(
    site: Site, browser: str, monkeypatch: pytest.MonkeyPatch, library: str, codec: str
) -> None:
    if library == "OpenCV":
        monkeypatch.setitem(sys.modules, "av", None)
    encoder = open_encoder(site.video, PER_S, 320, 240)
    for number in range(PICTURES):
        encoder.write(np.full((240, 320, 3), 10 * number, np.uint8))
    encoder.close()
    assert encoder.codec == codec
    profile = f"--user-data-dir={site.video.parent / 'browser'}"
    address = f"http://127.0.0.1:{site.server_port}/"
    command = [browser, *OPTIONS, profile, address]
    playing = subprocess.Popen(command, stderr=subprocess.DEVNULL, start_new_session=True)
    try:
        assert site.reports.get(timeout=WAIT_S) == "320x240 until 1.0 s"
    finally:
        os.killpg(playing.pid, signal.SIGKILL)  # the command may be a script that starts the browser
        playing.wait()
