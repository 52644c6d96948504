"""Pictures for tests: simulated frames of a rolling ball, as files and as a network stream."""

import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from fwk import Clock, Component, Writes
from fwk.clock import sleep_s
from fwk.testing import MemorySystem
from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.simulation.camera import Camera
from procs.vision.colours import Picture
from procs.vision.omni_ball import OmniBall
from procs.vision.omni_field import OmniField


class World(Component):
    """A ball rolls past two robots."""

    stage = "pre_loop"
    ground_truth: Writes[ground_truth_t]
    clock: Clock

    def loop(self) -> None:
        truth = self.ground_truth.value
        truth.robots = [robot("cyan1", -3.0, 2.0, 0.5), robot("magenta2", -1.0, 2.0, 0.0)]
        truth.ball_x_m, truth.ball_y_m = -2.0 + 0.05 * self.clock.tick, 3.0
        self.ground_truth.write()


def robot(name: str, x_m: float, y_m: float, heading_rad: float) -> true_robot_t:
    made = true_robot_t()
    made.name, made.x_m, made.y_m, made.heading_rad = name, x_m, y_m, heading_rad
    return made


def system(seed: int = 1, turns: tuple[int, int] = (1, 0), **camera: Any) -> MemorySystem:
    """The simulated camera with both detectors."""
    return MemorySystem(
        {"world/world": World, "cyan1/camera": Camera, "cyan1/omni_ball": OmniBall, "cyan1/omni_field": OmniField},
        settings={"cyan1/camera": camera},
        seed=seed,
        turns={"cyan1/camera": turns},
    )


def frame_of(run: MemorySystem) -> Any:
    """Returns the pixels of the newest frame, as the detectors received them."""
    if not run.ticks:
        run.tick()
    image: Any = run.runners["cyan1/omni_ball"].component
    return image.image.pixels


def simulated(count: int) -> tuple[list[Picture], MemorySystem]:
    """Returns frames of the first ticks, and the system that has seen them."""
    run, pictures = system(latency_s=0.0), []
    for _ in range(count):
        run.tick()
        pictures.append(frame_of(run).copy())
    return pictures, run


def shades(count: int, height_px: int = 120, width_px: int = 160) -> list[Picture]:
    """Returns plain pictures, each brighter than the one before by 8 of 255."""
    return [np.full((height_px, width_px, 3), 8 * number, np.uint8) for number in range(count)]


def write_folder(folder: Path, pictures: list[Picture]) -> Path:
    """Writes pictures without leading zeros in their numbers, and a file that is not a picture."""
    folder.mkdir()
    (folder / "readme.txt").write_text("pictures")
    for number, pixels in enumerate(pictures):
        cv2.imwrite(str(folder / f"frame{number}.png"), pixels)
    return folder


def write_video(file: Path, pictures: list[Picture]) -> Path:
    height_px, width_px = pictures[0].shape[:2]
    kind = "FFV1" if file.suffix == ".avi" else "mp4v"
    writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*kind), 20.0, (width_px, height_px))
    for pixels in pictures:
        writer.write(pixels)
    writer.release()
    return file


def read(file: Path) -> Picture:
    return np.asarray(cv2.imread(str(file)), np.uint8)


class Stream:
    """A network camera that sends the same picture to every client repeatedly."""

    def __init__(self, pixels: Picture, port: int = 0) -> None:
        jpeg = cv2.imencode(".jpg", pixels)[1].tobytes()
        ending = self._ending = threading.Event()

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                self.send_response(200)
                self.send_header("Content-Type", "multipart/x-mixed-replace; boundary=frame")
                self.end_headers()
                while not ending.is_set():
                    head = f"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: {len(jpeg)}\r\n\r\n"
                    try:
                        self.wfile.write(head.encode() + jpeg + b"\r\n")
                    except OSError:
                        return
                    sleep_s(0.01)

            def log_message(self, *_: object) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self._server.daemon_threads = True
        self.port = int(self._server.server_address[1])
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.02,), daemon=True)
        self._thread.start()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/camera.mjpeg"

    def end(self) -> None:
        """Stops the server."""
        self._ending.set()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
