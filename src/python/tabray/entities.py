"""The entity types of the scene language: a function for each, which makes the dict of one entity.

`tabray.entities.sphere("ball", material="red", center=[0, 0, 0], radius=2)` is
`{"sphere": {"ball": {"material": "red", "center": [0, 0, 0], "radius": 2}}}`, for `tabray.scene`. `help` on a function shows
the attributes. All of it comes from the tables with which scenes are checked.
"""

from __future__ import annotations

import json
import keyword
from inspect import Parameter, Signature
from typing import Any, Callable

from ._native import tables

Entity = dict[str, dict[str, dict[str, Any]]]


def _described(attribute: dict[str, Any]) -> str:
    """Describe an attribute in a line of the function's help."""
    counts, kind = attribute["counts"], attribute["type"]
    if attribute["choices"]:
        kind = "one of " + ", ".join(choice["name"] for choice in attribute["choices"])
    elif attribute["refers_to"]:
        kind = f"the name of a {attribute['refers_to']}"
    number = f"{' or '.join(map(str, counts))} x {kind}" if counts and counts != [1] else kind
    default = "required" if attribute["required"] else f"default {json.dumps(attribute['default'])}"
    if not attribute["required"] and attribute["default"] is None:
        default = "optional"
    unit = f", in {attribute['unit']}" if attribute["unit"] else ""
    rule = f"; must be {attribute['must_be']}" if attribute["must_be"] else ""
    return f"    {attribute['name']}: {attribute['meaning']}{unit}{rule} ({number}, {default})"


def _function(entity: dict[str, Any]) -> Callable[..., Entity]:
    """Make the function of an entity type."""
    kind = entity["name"]

    def make(name: str, **attributes: Any) -> Entity:
        return {kind: {name: {key.removesuffix("_"): value for key, value in attributes.items()}}}

    make.__name__ = make.__qualname__ = kind
    make.__module__ = __name__
    meaning = entity["meaning"]
    lines = [f"{meaning[0].upper()}{meaning[1:]} ({entity['kind']}).", ""]
    lines += [_described(attribute) for attribute in entity["attributes"]]
    lines += [f"\nExactly one of {', '.join(group['names'])} is given." for group in entity["one_of"]]
    make.__doc__ = "\n".join(lines)
    names = [attribute["name"] for attribute in entity["attributes"]]
    # Python's own words take an underscore at their end.
    names = [name + "_" if keyword.iskeyword(name) else name for name in names]
    own = [Parameter(name, Parameter.KEYWORD_ONLY, default=None) for name in names if name.isidentifier() and name != "name"]
    signature = Signature([Parameter("name", Parameter.POSITIONAL_ONLY), *own])
    setattr(make, "__signature__", signature)
    return make


_FUNCTIONS = {entity["name"]: _function(entity) for entity in json.loads(tables())["entities"]}

__all__ = sorted(_FUNCTIONS)


def __getattr__(name: str) -> Callable[..., Entity]:
    try:
        return _FUNCTIONS[name]
    except KeyError:
        known = ", ".join(__all__)
        raise AttributeError(f"there is no entity type `{name}`: the entity types are {known}") from None


def __dir__() -> list[str]:
    return __all__
