"""Scenes of dicts as texts: the reader of the program is the only one."""

from __future__ import annotations

import json
from typing import Any, Iterable, Mapping, Sequence, Union

from ._places import Path, Places

Value = Union[bool, int, float, str, Sequence[Any], Any]
"""The value of an attribute: a number, a word, or several of them, also as a NumPy array."""

Entities = Union[Mapping[str, Any], Iterable[Mapping[str, Any]]]


def as_toml(entities: Entities, names: Mapping[Path, str] | None = None) -> Places:
    """Write entities in TOML. `names` are what messages call some parts of them."""
    is_one = isinstance(entities, Mapping)
    parts = [entities] if isinstance(entities, Mapping) else list(entities)
    lets: dict[str, tuple[Path, Value]] = {}
    named_by_kind: list[tuple[Path, Any]] = []
    for index, part in enumerate(parts):
        for kind, named in part.items():
            path: Path = (kind,) if is_one else (index, kind)
            if not isinstance(named, Mapping):
                raise TypeError(f"`{kind}` is {_called(named)}: give a dict of names and their entities")
            if kind == "let":
                lets.update((name, ((*path, name), value)) for name, value in named.items())
                continue
            for name, attributes in named.items():
                if not isinstance(attributes, Mapping):
                    raise TypeError(f"{kind} `{name}` is {_called(attributes)}: give a dict of its attributes")
                named_by_kind.append(((*path, name), attributes))
    places = Places("scene", names or {})
    if lets:
        places.add("[let]\n")
        for name, (path, value) in lets.items():
            _write(places, path, name, value)
    for path, attributes in named_by_kind:
        with places.part(path):
            places.add(f"[{_key(path[-2])}.{_key(path[-1])}]\n")
            for key, value in attributes.items():
                if value is not None:
                    _write(places, (*path, key), key, value)
    return places


def _write(places: Places, path: Path, key: object, value: Value) -> None:
    """Write a key with its value."""
    parts = _parts(value, ("false", "true"))
    with places.part(path):
        places.add(f"{_key(key)} = ")
        if isinstance(parts, str):
            with places.part(path, is_word=parts.startswith('"')):
                places.add(parts)
        else:
            places.add("[")
            for index, word in enumerate(parts):
                places.add(", " if index else "")
                with places.part((*path, index), is_word=word.startswith('"')):
                    places.add(word)
            places.add("]")
    places.add("\n")


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
