"""Faults of scenes, as exceptions and warnings."""

from __future__ import annotations

import json
import warnings
from typing import Any, NamedTuple

from ._places import NAME, Places, current


class Fault(NamedTuple):
    """One thing that is wrong with a scene."""

    message: str
    """What is wrong."""
    path: str | None
    """The scene as messages name it, the file that it includes, or the part of a scene of dicts."""
    line: int | None
    """The line of the place, from 1."""
    column: int | None
    """The first column of the place, from 1, in characters."""
    span: tuple[int, int] | None
    """The first byte of the place, from 0, and the first after it."""
    label: str | None
    """A few words about the place."""
    help: str | None
    """What would be right."""
    is_error: bool
    """Whether the scene cannot be made; otherwise it is a warning."""


class SceneError(ValueError):
    """A scene has faults. The text is what the command line prints, and `faults` lists the faults."""

    def __init__(self, message: str, report: str) -> None:
        faults = _faults(report)
        # The text of a scene of dicts is none that anybody wrote.
        super().__init__("\n\n".join(text for _, text in faults) if faults and current() else message)
        self.faults: list[Fault] = [fault for fault, _ in faults]

    def __reduce__(self) -> tuple[object, ...]:
        return (_again, (str(self), self.faults))


class SceneWarning(UserWarning):
    """Something about a scene or its image that may not be as intended."""


def _again(message: str, faults: list[Fault]) -> SceneError:
    error = SceneError(message, "")
    error.faults = faults
    return error


def _faults(report: str) -> list[tuple[Fault, str]]:
    """Read the messages of a report, which are JSON, one on each line, as faults with their texts."""
    faults = []
    for line in report.splitlines():
        message = json.loads(line)
        places = current()
        if places and all(place["file_name"] == NAME for place in message["spans"]):
            faults.append(_of_dicts(message, places))
            continue
        place = next((place for place in message["spans"] if place["is_primary"]), None)
        fault = Fault(
            message=message["message"],
            path=place and place["file_name"],
            line=place and place["line_start"],
            column=place and place["column_start"],
            span=place and (place["byte_start"], place["byte_end"]),
            label=place and place["label"],
            help=message["help"],
            is_error=message["level"] == "error",
        )
        faults.append((fault, message["rendered"]))
    return faults


def _of_dicts(message: dict[str, Any], places: Places) -> tuple[Fault, str]:
    """Read a message about a scene of dicts, which names their parts."""
    lines: list[str] = [f"{message['level']}: {message['message']}"]
    path: str | None = None
    label: str | None = None
    for place in message["spans"]:
        name, where = places.called(place["byte_start"], place["byte_end"])
        arrow, words = ("-->" if place["is_primary"] else ":::"), (f": {place['label']}" if place["label"] else "")
        lines.append(f" {arrow} {name}{where}{words}")
        if place["is_primary"]:
            path, label = name, place["label"]
    if message["help"]:
        lines.append(f"  = help: {message['help']}")
    is_error = message["level"] == "error"
    fault = Fault(message["message"], path, None, None, None, label, message["help"], is_error)
    return fault, "\n".join(lines)


# How far the caller's own code is from here: `warn`, the scene's reader in `__init__.py`, and what called that.
_CALLER = 3

# A scene of dicts has one more reader.
_CALLER_OF_DICTS = 4


def warn(report: str) -> None:
    """Warn of each fault of a report."""
    for _, text in _faults(report):
        warnings.warn(SceneWarning(text), stacklevel=_CALLER_OF_DICTS if current() else _CALLER)


def warn_of_image(message: str) -> None:
    """Warn of something about an image."""
    warnings.warn(SceneWarning(message), stacklevel=_CALLER - 1)
