"""What ``show`` and ``list`` print, read from data so that SymPy stays out of it."""

import json
from functools import cache
from pathlib import Path
from typing import Any

DATA = Path(__file__).with_name("shown.json")


@cache
def _equations() -> dict[int, dict[str, Any]]:
    content = json.loads(DATA.read_text(encoding="utf-8"))
    return {entry["number"]: entry for entry in content["equations"]}


def titles() -> dict[int, tuple[str, str]]:
    """Name and title of every equation, by number."""
    return {number: (entry["name"], entry["title"]) for number, entry in _equations().items()}


def view(number: int, kind: str) -> str:
    """One equation as text, latex, sympy, python or steps."""
    return str(_equations()[number]["views"][kind])


def exact_numbers() -> list[int]:
    """The equations that have an exact form at finite M."""
    return [number for number, entry in _equations().items() if entry.get("exact")]


def exact_places(number: int) -> list[str]:
    """The cases with an exact form of their own, the usual one first."""
    return list(_equations()[number].get("exact", {}))


def exact_view(number: int, place: str, kind: str) -> str:
    """The exact form of one equation at one place."""
    return str(_equations()[number]["exact"][place][kind])
