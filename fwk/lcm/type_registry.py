"""Finds the LCM type of recorded bytes by their fingerprint, among all generated types."""

import importlib
import pkgutil
import sys
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import lcmtypes
from fwk.lcm import envelope, messages, typegen

MessageType = type[messages.Message]


def put_first(folders: Sequence[str]) -> None:
    """Puts folders in front of the module search path, in this order: their modules win over installed ones."""
    sys.path[:] = [*folders, *(entry for entry in sys.path if entry not in folders)]
    importlib.invalidate_caches()


def use_types_of(folder: Path) -> None:
    """Adds the types of `folder`/lcmtypes/*.lcm, generating their classes where needed; no such folder adds nothing.

    Raises:
        TypeGenerationError: an .lcm file does not parse.
    """
    if any((folder / "lcmtypes").glob("*.lcm")):
        typegen.generate((folder / "lcmtypes").resolve())
        put_first([str(folder.resolve())])
        by_fingerprint.cache_clear()
        _interfaces.cache_clear()
        _in_envelopes.cache_clear()


def source_folders() -> list[Path]:
    """The folders of all .lcm files in use, each once."""
    return list(dict.fromkeys(Path(folder).resolve() for folder in lcmtypes.__path__))


@cache
def by_fingerprint() -> dict[bytes, tuple[MessageType, ...]]:
    """All generated types. Those with the same members have the same fingerprint: LCM leaves the struct's name out."""
    found: dict[bytes, tuple[MessageType, ...]] = {}
    for package in sorted(module.name for module in pkgutil.iter_modules(lcmtypes.__path__) if module.ispkg):
        for _, made in sorted(vars(import_module(f"lcmtypes.{package}")).items()):
            if isinstance(made, type) and hasattr(made, "_get_packed_fingerprint"):
                mark = messages.fingerprint(made)
                found[mark] = (*found.get(mark, ()), made)
    return found


def types_of(data: bytes) -> tuple[MessageType, ...]:
    """The types that a message may be of, also one in its envelope; they all decode it alike. Empty: unknown."""
    return by_fingerprint().get(data[:8]) or _in_envelopes().get(data[:8], ())


def decoded(data: bytes) -> Any:
    """The message; that in an envelope without it. Raises whatever generated code raises, or `LookupError`."""
    return types_of(data)[0].decode(envelope.content(data) if in_envelope(data) else data)


def in_envelope(data: bytes) -> bool:
    """Whether these bytes are the message of a known type without our header, in its envelope."""
    return data[:8] in _in_envelopes()


def is_interface(data: bytes) -> bool:
    """Whether a message has a header, by its type: its own, or that of an envelope."""
    return data[:8] in _interfaces()


@cache
def _interfaces() -> frozenset[bytes]:
    return frozenset(mark for mark, found in by_fingerprint().items() if messages.has_header(found[0])) | set(
        _in_envelopes()
    )


@cache
def _in_envelopes() -> dict[bytes, tuple[MessageType, ...]]:
    return {
        envelope.marked(mark): found for mark, found in by_fingerprint().items() if not messages.has_header(found[0])
    }


def header_of(data: bytes) -> messages.Header | None:
    """The header of a message of an interface; None for everything else."""
    if not is_interface(data):
        return None
    try:
        return messages.Header.of(data)
    except messages.MessageError:
        return None
