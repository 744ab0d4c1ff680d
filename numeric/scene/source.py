"""Where an answer came from: the scene with all that it left unsaid, its seed, and what it read."""

import hashlib
from fractions import Fraction
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from ..arithmetic.decimals import decimal_string
from .scene import Scene
from .sections import GivenRadii, Section

PROGRAM = "force-diffusion"


@cache
def program_version() -> str:
    """Version of this package, or "unknown" where it is not installed."""
    try:
        return version(PROGRAM)
    except PackageNotFoundError:
        return "unknown"


def files_read(scene: Scene) -> dict[str, str]:
    """Give the SHA-256 of the bytes of the files of radii and loads, as they are now."""
    disorder, load = scene.disorder, scene.load
    radii = None if disorder is None else disorder.file
    files = {"disorder.file": radii, "load.file": load.file}
    return {key: sha256(scene.folder / file) for key, file in files.items() if file is not None}


def source_of(scene: Scene, files: dict[str, str] | None = None) -> dict[str, Any]:
    """Give program, version, scene, seed (null where nothing is drawn) and SHA-256 of what is read.

    Numbers of the scene are strings, exact. ``sha256`` is that of the ``files_read``, and of the
    doubles of an array, in the order of its rows.
    """
    named = (("packing", scene.packing), ("disorder", scene.disorder), ("load", scene.load),
             ("effects", scene.effects), ("ask", scene.ask))  # fmt: skip
    sections = {name: _said(section) for name, section in named if section is not None}
    sections["packing"]["spacing"] = _exact(scene.spacing)
    disorder, hashes = scene.disorder, dict(files_read(scene) if files is None else files)
    if isinstance(disorder, GivenRadii):
        sections["disorder"] = {"kind": "given", disorder.name: list(disorder.values.shape)}
        hashes[f"disorder.{disorder.name}"] = hashlib.sha256(disorder.values.tobytes()).hexdigest()
    drawn = disorder is not None and disorder.kind not in {"file", "given"}
    return {
        "program": PROGRAM,
        "version": program_version(),
        "scene": sections,
        "seed": disorder.seed if drawn and disorder is not None else None,
        "sha256": hashes,
    }


def sha256(path: Path) -> str:
    """Give the SHA-256 of a file that was read before."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _said(section: Section) -> dict[str, Any]:
    values = {name: getattr(section, name) for name in type(section).model_fields}
    return {name: _exact(value) for name, value in values.items() if value is not None}


def _exact(value: Any) -> Any:
    if not isinstance(value, Fraction):
        return value
    shown = decimal_string(value, None)
    return shown if Fraction(shown) == value else str(value)
