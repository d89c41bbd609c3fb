"""Scenes of dicts as texts: the reader of the program is the only one."""

from __future__ import annotations

import json
from typing import Any, Iterable, Mapping, Sequence, Union

Value = Union[bool, int, float, str, Sequence[Any], Any]
"""The value of an attribute: a number, a word, or several of them, also as a NumPy array."""

Entities = Union[Mapping[str, Any], Iterable[Mapping[str, Any]]]


def as_toml(entities: Entities) -> str:
    """Write entities in TOML."""
    parts = [entities] if isinstance(entities, Mapping) else list(entities)
    lets: dict[str, Value] = {}
    lines: list[str] = []
    for part in parts:
        for kind, named in part.items():
            if not isinstance(named, Mapping):
                raise TypeError(f"`{kind}` is {_called(named)}: give a dict of names and their entities")
            if kind == "let":
                lets.update(named)
                continue
            for name, attributes in named.items():
                if not isinstance(attributes, Mapping):
                    raise TypeError(f"{kind} `{name}` is {_called(attributes)}: give a dict of its attributes")
                lines.append(f"[{_key(kind)}.{_key(name)}]")
                lines += [f"{_key(key)} = {_value(value)}" for key, value in attributes.items() if value is not None]
    if lets:
        lines[:0] = ["[let]"] + [f"{_key(key)} = {_value(value)}" for key, value in lets.items()]
    return "\n".join(lines) + "\n"


def as_sets(values: Mapping[str, Value] | None) -> list[str]:
    """Write values that are set beside a scene as `--set` has them."""
    return [f"{name}={_words(value)}" for name, value in (values or {}).items()]


def _called(value: object) -> str:
    return f"of the type {type(value).__name__}"


def _key(name: object) -> str:
    if not isinstance(name, str):
        raise TypeError(f"`{name}` is no name: give a str")
    is_bare = name.isascii() and name.replace("-", "a").replace("_", "a").isalnum()
    return name if is_bare else _quoted(name)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Value) -> str:
    """Write a value in TOML."""
    parts = _parts(value, ("false", "true"))
    return parts if isinstance(parts, str) else "[" + ", ".join(parts) + "]"


def _words(value: Value) -> str:
    """Write a value as in a `.ray` file."""
    parts = _parts(value, ("no", "yes"))
    return parts if isinstance(parts, str) else " ".join(parts)


def _parts(value: Value, truth: tuple[str, str]) -> str | list[str]:
    """Write a value, or each of several."""
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, bool):
        return truth[value]
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, Iterable) and not isinstance(value, (bytes, Mapping)):
        parts = [_parts(part, truth) for part in value]
        # Several rows are written one after the other.
        return [word for part in parts for word in ([part] if isinstance(part, str) else part)]
    raise TypeError(f"a value {_called(value)}: give a number, a str, or several of them")
