"""Scenes with other values than their files have: ``--set``, several for a sweep."""

import math
import re
from itertools import product
from typing import Annotated

import typer

MOST = 1000  # scenes of a sweep
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=V,V...",
        help="Use these values for a key of the scene, such as packing.height=8,16,32. With --out "
        "each answer gets its own folder.",
    ),
]


def variants(settings: list[str] | None) -> list[dict[str, str]]:
    """Give the values by key of every scene of a sweep; one scene, unchanged, without any."""
    keys: dict[str, list[str]] = {}
    for word in settings or []:
        key, equals, values = word.partition("=")
        if not equals or not key or key in keys:
            raise typer.BadParameter(
                f"'{word}' sets nothing{' more than once' * (key in keys)}. Give KEY=V or "
                "KEY=V,V..., such as packing.height=8,16,32, once for a key.",
                param_hint="--set",
            )
        keys[key] = _apart(values)
    number = math.prod(map(len, keys.values()))
    if number > MOST:
        raise typer.BadParameter(
            f"asks for {number} scenes; {MOST} are allowed.", param_hint="--set"
        )
    return [dict(zip(keys, values, strict=True)) for values in product(*keys.values())]


def _apart(values: str) -> list[str]:
    """Split values at the commas outside of lists and quotes.

    >>> _apart('8,16'), _apart('[0, 0, "+"],[2, 0, "-"]')
    (['8', '16'], ['[0, 0, "+"]', '[2, 0, "-"]'])
    """
    parts = [*map(str.strip, re.findall(r"((?:\[[^\]]*\]|\"[^\"]*\"|[^,])+)(?:,|$)", values))]
    return parts or [values]


def name_of(changes: dict[str, str]) -> str:
    """Name a folder for a scene of a sweep.

    >>> name_of({"packing.height": "8", "load.kind": '"point"'})
    'packing.height=8,load.kind=point'
    """
    words = ",".join(f"{key}={value}" for key, value in changes.items()).replace('"', "")
    return re.sub(r"[^\w.,=+-]+", "_", words, flags=re.ASCII)
