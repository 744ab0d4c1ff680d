"""Scenes from TOML files, checked before anything is computed."""

import json
import re
import shlex
import tomllib
from collections.abc import Mapping
from decimal import Decimal
from pathlib import Path
from typing import TypeVar

from .files import ForeignFileError, opened
from .scene import CheckedScene
from .sections import SceneError, unknown

LARGEST_FILE = 16_000  # bytes of a scene file, in which nothing takes long to read
LONGEST_VALUE = 6000
S = TypeVar("S", bound=CheckedScene)
_NO_SCENE = "is not a scene, which is a TOML file with [packing] and [ask]"
_WORD = re.compile(r"(?!(true|false|inf|nan)$)[A-Za-z][A-Za-z_-]*", re.ASCII)


def read_scene(path: Path, kind: type[S], changes: Mapping[str, str] | None = None) -> S:
    """Read and check a scene file. Raises ``SceneError``.

    ``changes`` are keys, as "packing.height", with values as a scene file has them.
    """
    table = ""
    if path.suffix in {".csv", ".npy", ".txt"}:  # of radii or loads, taken for a scene
        table = (
            '; a table of radii is named in a scene, as disorder = {kind = "file", '
            'file = "radii.csv"}, and the scene is run'
        )
    try:
        with opened(path, LARGEST_FILE) as file:
            text = file.read(LARGEST_FILE).decode("utf-8")
    except UnicodeDecodeError:
        raise SceneError(str(path), None, f"{_NO_SCENE}, in UTF-8{table}") from None
    except ForeignFileError as error:
        said = f"{_NO_SCENE}: {error}" if table and path.exists() else str(error)
        raise SceneError(str(path), None, said + table) from None
    try:
        return parse_scene(text, kind, path.parent, changes)
    except SceneError as error:
        if error.key == "scene":
            raise SceneError(str(path), None, error.allowed + table) from None
        error.add_note(path.name)
        raise


def _value(name: str, written: str) -> object:
    """Read one value; a bare word is a string."""
    if _WORD.fullmatch(written):
        return written
    try:
        if len(written) > LONGEST_VALUE or "\n" in written:
            raise ValueError
        value: object = tomllib.loads(f"value = {written}", parse_float=Decimal)["value"]
    except (ValueError, ArithmeticError, RecursionError):
        why = "is not a TOML value, such as 8, 1e-4 or [0, 10]"
        if len(written) <= LONGEST_VALUE and re.match(r"[A-Za-z_./~]", written):
            text = json.dumps(written, ensure_ascii=False)  # quotes, which shells take away
            why += f"; text goes in quotes: say --set {shlex.quote(f'{name}={text}')}"
        raise SceneError(name, written, why) from None
    return value


def parse_scene(
    text: str, kind: type[S], folder: Path = Path(), changes: Mapping[str, str] | None = None
) -> S:
    """Check the text of a scene, whose files lie in ``folder``. Raises ``SceneError``.

    >>> parse_scene('packing = {height = 4}\\nask = {quantity = "profle"}', CheckedScene)
    Traceback (most recent call last):
    ...
    force_diffusion.numeric.scene.sections.SceneError: ask.quantity = "profle": must be one of \
"contact", "contact_forces", "positions", "profile", "histogram", "response"; did you mean \
"profile"?
    """
    try:
        raw = tomllib.loads(text, parse_float=Decimal)
    except RecursionError:
        raise SceneError("scene", None, "is nested too deeply") from None
    except tomllib.TOMLDecodeError as error:
        raise SceneError("scene", None, f"{_NO_SCENE} ({error})") from None
    except (ArithmeticError, ValueError):
        why = "has a number with a huge exponent, or an integer of more than 4300 digits"
        raise SceneError("scene", None, why) from None
    if "folder" in raw:
        raise SceneError("folder", raw["folder"], unknown("folder", CheckedScene))
    for name, written in (changes or {}).items():
        section, _, key = name.partition(".")
        keys = raw.setdefault(section, {})
        if not key or "." in key or not isinstance(keys, dict):
            raise SceneError(name, None, "is not a key of a section, such as packing.height")
        keys[key] = _value(name, written)
    return kind(**raw, folder=folder)
