"""Where the words of a text that is made of dicts come from: messages about it name the dicts, and show none of the text."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import Iterator, Mapping, Sequence, Union

Path = tuple[Union[int, str], ...]
"""The keys and the indices that lead to a part of dicts and lists."""


class Places:
    """The parts of dicts that the words of a text were made of."""

    def __init__(self, root: str, names: Mapping[Path, str]) -> None:
        """`root` is what the whole is called, and `names` what some parts are called instead of their paths."""
        self.root, self.names = root, names
        self.text = bytearray()
        self._spans: list[tuple[int, int, Path, bool]] = []

    def add(self, text: str) -> None:
        """Add text that is no part by itself."""
        self.text += text.encode()

    @contextmanager
    def part(self, path: Path, is_word: bool = False) -> Iterator[None]:
        """Say that the text that is added meanwhile is made of a part; `is_word` says that it is one word in quotes."""
        start = len(self.text)
        yield
        self._spans.append((start, len(self.text), path, is_word))

    def called(self, start: int, end: int) -> tuple[str, str]:
        """Return what the smallest part is called that some bytes of the text are made of, and where they are in a word."""
        around = [span for span in self._spans if span[0] <= start and end <= span[1]]
        if not around:
            return self.root, ""
        first, last, path, is_word = min(around, key=lambda span: span[1] - span[0])
        is_part = is_word and first < start < end < last and (first + 1, last - 1) != (start, end)
        return self._name(path), f", at `{self.text[start:end].decode(errors='replace')}`" if is_part else ""

    def _name(self, path: Path) -> str:
        for length in range(len(path), 0, -1):
            if path[:length] in self.names:
                return self.names[path[:length]] + _brackets(path[length:])
        return self.root + _brackets(path)


def _brackets(path: Sequence[Union[int, str]]) -> str:
    return "".join(f"[{part}]" if isinstance(part, int) else f'["{part}"]' for part in path)


NAME = "<scene>.toml"
"""What the reader of the program calls a text that is made of dicts."""

_current: ContextVar[Places | None] = ContextVar("places", default=None)


@contextmanager
def told_by(places: Places) -> Iterator[None]:
    """Let messages about the text that is read meanwhile name its parts."""
    token = _current.set(places)
    try:
        yield
    finally:
        _current.reset(token)


def current() -> Places | None:
    """Return the places of the text that is read, if it is made of dicts."""
    return _current.get()
