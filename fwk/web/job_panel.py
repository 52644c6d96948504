"""Element that runs a command of fwk and shows its line, its output and its end."""

from collections.abc import Awaitable, Callable, Sequence

from nicegui import background_tasks, ui

from fwk.web.access import Role
from fwk.web.job import Job
from fwk.web.layout import Frame
from fwk.web.lines import Lines

_LOOK_S = 0.3
_ENDS = {0: "done", 1: "different, or failed", 2: "refused"}


class JobPanel:
    """One command at a time; a browser that may only read starts none."""

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._job: Job | None = None
        self._told: list[str] = []
        self._count = 0
        with ui.column().classes("w-full gap-1") as self._area:
            with ui.row().classes("items-center no-wrap"):
                self._spinner = ui.spinner(size="sm")
                self._title = ui.label("").classes("fwk-value").props("data-name=job")
                self._stop = ui.button("end", icon="stop", on_click=self._end).props("dense outline no-caps size=sm")
            self._lines = Lines()
            self._lines.classes("fwk-output").props("data-name=output")
        self._area.set_visibility(False)
        ui.timer(_LOOK_S, self._show)

    def start(self, words: Sequence[str], then: Callable[[], Awaitable[None]] | None = None) -> None:
        """Starts a command unless one runs already; calls `then` after its end."""
        if self._frame.role is not Role.STEER:
            ui.notify("this console is for reading only", type="negative")
            return
        if self._job and self._job.code is None:
            ui.notify(f"first wait for: {' '.join(self._job.words)}", type="warning")
            return
        self._job = Job(words, self._told.append)
        self._lines.clear_lines()
        self._area.set_visibility(True)
        background_tasks.create(self._run(self._job, then))

    async def _run(self, job: Job, then: Callable[[], Awaitable[None]] | None) -> None:
        try:
            await job.run()
        except OSError as error:
            job.code = 2
            self._told.append(f"error: {error}\n")
            return
        if then:
            with self._area:
                await then()

    def _show(self) -> None:
        job = self._job
        if job is None:
            return
        runs = job.code is None
        end = "" if job.code is None else _ENDS.get(job.code, f"ended with {job.code}")
        self._title.set_text(f"$ {' '.join(job.words)}   {f'{job.age_s:.0f} s' if runs else end}")
        self._spinner.set_visibility(runs)
        self._stop.set_visibility(runs)
        if self._told:
            text, self._told[:] = "".join(self._told), []
            rows = [(self._count + number, "", line, 0) for number, line in enumerate(text.splitlines(), 1)]
            self._count += len(rows)
            self._lines.append(rows)

    def _end(self) -> None:
        if self._job:
            self._job.end()
