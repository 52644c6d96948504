"""Reloads components when their source files change; runs in a process of its own."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError, RefusedError
from fwk.model.plan import Plan
from fwk.plan.files.launch_file import shown
from fwk.plan.files.source_files import Sources, mistakes

_LOOK_MS = 200  # interval of checks for the end
_TIMEOUT_S = 60.0


class Watcher:
    """Reloads components whose files changed; files that cannot be compiled are reported in the run's log."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._sources = Sources(plan)
        self._pending: set[Path] = set()  # changed, not reloaded yet because of a mistake

    def run(self, stopping: Callable[[], bool]) -> None:
        """Watches until `stopping` returns true or the run has ended."""
        from watchfiles import PythonFilter, watch  # imported only with --watch

        while not stopping():
            folders = self._folders()
            for changes in watch(
                *folders,
                watch_filter=PythonFilter(),
                recursive=False,
                rust_timeout=_LOOK_MS,
                yield_on_timeout=True,
                raise_interrupt=False,
            ):
                if changes:
                    self.changed({Path(file).resolve() for _, file in changes})
                if stopping() or (changes and self._folders() != folders):
                    break

    def changed(self, files: set[Path]) -> None:
        """Handles changed files."""
        self._pending |= files
        concerned = self._concerned()
        if not concerned:
            return
        wrong = mistakes(self._pending & set[Path]().union(*concerned.values()))
        try:
            with Client(supervisor_address(self._plan.bus_port), _TIMEOUT_S) as run:
                if wrong:
                    text = f"{'; '.join(wrong)}; not reloaded, so the old code continues: {', '.join(concerned)}"
                    run.ask("note", level="warning", text=text)
                    return
                self._reload(run, concerned)
        except RefusedError as error:
            self._tell(f"not reloaded: {error}")
        except ControlError:
            return  # the run ends
        else:
            self._pending.clear()

    def _reload(self, run: Client, concerned: dict[str, set[Path]]) -> None:
        states = run.ask("status")["components"]
        processes = {each["process"] for each in states if each["name"] in concerned and _is_wanted(each)}
        names = [each["name"] for each in states if each["process"] in processes]
        if names:
            why = ", ".join(sorted(shown(file) for file in self._pending))
            run.ask("note", level="info", text=f"{why} changed; reloading {', '.join(names)}")
            run.ask("steer", action="reload", names=names)

    def _concerned(self) -> dict[str, set[Path]]:
        """Returns the components that a changed file belongs to, each with all its files."""
        consists = {component.name: self._sources.files(component) for component in self._plan.components}
        return {name: files for name, files in consists.items() if files & self._pending}

    def _folders(self) -> list[Path]:
        files = {file for component in self._plan.components for file in self._sources.files(component)}
        return sorted({file.parent for file in files})

    def _tell(self, text: str) -> None:
        with Client(supervisor_address(self._plan.bus_port)) as run:
            run.ask("note", level="warning", text=text)


def _is_wanted(component: dict[str, Any]) -> bool:
    return bool(component["wanted"] == "running")
