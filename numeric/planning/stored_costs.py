"""The calibration of this machine, kept in the user's cache folder.

The file is outside text: it is validated, and refused where it is damaged, was made by other
versions or on another machine. It is written aside and renamed, so that it is never half there.
"""

import os
import platform
import sys
import tempfile
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from force_diffusion.numeric.planning.cost_model import Model, defaults
from platformdirs import user_cache_path
from pydantic import BaseModel, ConfigDict, Field, ValidationError

SCHEMA = 1
LARGEST_FILE = 1_000_000
PACKAGES = ("force-diffusion", "numpy", "python-flint", "mpmath", "gmpy2", "numba")
# No unit of work takes as long: a coefficient beyond that is no measurement.
MOST_SECONDS = 100.0


class StaleError(ValueError):
    """There is no stored calibration that holds here; the message says why."""


class Stored(BaseModel):
    """What the file holds."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    program: str
    schema_version: int = Field(ge=0)
    machine: dict[str, str]
    versions: dict[str, str]
    model: Model


def location() -> Path:
    """Give the file: in the user's cache folder, as the system's custom is."""
    return user_cache_path("force-diffusion", appauthor=False) / "calibration.json"


def machine() -> dict[str, str]:
    """Identify the machine, as far as speed depends on it."""
    return {
        "name": platform.node(),
        "system": platform.system(),
        "architecture": platform.machine(),
        "processor": _processor(),
        "cores": str(os.cpu_count() or 1),
    }


def _processor() -> str:
    with suppress(OSError, UnicodeDecodeError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor()


def versions() -> dict[str, str]:
    """Give the versions that the times depend on; "none" where a package is missing."""
    found = {"python": platform.python_version(), "implementation": sys.implementation.name}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "none"
    return found


def load() -> Model:
    """Read the stored calibration. Raises ``StaleError`` where there is none that holds here."""
    path = location()
    try:
        if not path.is_file():
            why = "is no ordinary file" if path.exists() else "does not exist"
            raise StaleError(f"{path} {why}")
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise StaleError(f"{path} can't be read ({error.strerror})") from None
    if len(content) > LARGEST_FILE:
        raise StaleError(f"{path} is larger than any calibration")
    try:
        stored = Stored.model_validate_json(content)
    except (ValidationError, RecursionError):
        raise StaleError(f"{path} is damaged, or of another version of this program") from None
    if stored.program != "force-diffusion" or stored.schema_version != SCHEMA:
        raise StaleError(f"{path} is of another version of this program")
    for name, now in versions().items():
        if stored.versions.get(name) != now:
            was = stored.versions.get(name, "unknown")
            raise StaleError(f"{path} was made with {name} {was[:40]}, and this is {now}")
    if stored.machine != machine():
        raise StaleError(f"{path} was made on another machine")
    if not _complete(stored.model):
        raise StaleError(f"{path} is damaged: it lacks coefficients, or some can't be times")
    return stored.model


def _complete(model: Model) -> bool:
    """Say whether all coefficients are there that the defaults have, and could be times."""
    return model.load_seconds < MOST_SECONDS and all(
        step in model.families.get(family, {})
        and all(0 <= c < MOST_SECONDS for c in model.families[family][step].seconds.values())
        for family, steps in defaults().families.items()
        for step in steps
    )


def store(model: Model) -> Path:
    """Store a calibration; give its place. Raises ``OSError``."""
    stored = Stored(
        program="force-diffusion",
        schema_version=SCHEMA,
        machine=machine(),
        versions=versions(),
        model=model,
    )
    path = location()
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, aside = tempfile.mkstemp(prefix=".calibration-", dir=path.parent)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(stored.model_dump_json(indent=1) + "\n")
            file.flush()
            os.fsync(file.fileno())
        Path(aside).replace(path)
    except BaseException:
        with suppress(OSError):
            Path(aside).unlink()
        raise
    return path
