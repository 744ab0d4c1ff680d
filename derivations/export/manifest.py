"""``manifest.json`` of a folder of results: which files this program wrote, what ``derive`` found.

It is outside text: read within limits, and checked against the models below.
"""

import os
import stat
from pathlib import Path
from typing import Final, Literal

from pydantic import BaseModel, ConfigDict, ValidationError

MANIFEST = "manifest.json"
PROGRAM: Final = "force-diffusion"
LARGEST = 1_000_000


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True)


class Made(_Part):
    """How a file came to be; ``result_of`` is what it answers, such as "run scene.toml".

    ``seed`` is that of the radii, where they were drawn; ``inputs`` has the SHA-256 of the scene
    and of the files that it names, by their names.
    """

    result_of: str
    command: str
    version: str
    sha256: str
    seed: int | None = None
    inputs: dict[str, str] = {}


class FoundCheck(_Part):
    """A step, a proof or the refutation of a printed statement, and its verdict."""

    kind: Literal["step", "proof", "refutation"]
    name: str
    verdict: Literal["proved", "proved, assuming", "refuted", "undecided", "not a statement"]
    note: str
    assuming: tuple[str, ...] = ()


class FoundEquation(_Part):
    """What ``derive`` found about one equation; the same on every run."""

    number: int | str
    name: str
    title: str
    fragment: str
    premises: tuple[int | str, ...]
    verdict: Literal["proved", "proved, assuming", "refuted", "undecided"]
    checks: tuple[FoundCheck, ...]
    assuming: tuple[str, ...] = ()


class Manifest(_Part):
    """All that a folder's manifest says."""

    program: Literal["force-diffusion"]
    files: dict[str, Made]
    equations: tuple[FoundEquation, ...] = ()

    def text(self) -> str:
        """Give it as JSON."""
        return self.model_dump_json(indent=2, exclude_defaults=True) + "\n"


def read_manifest(folder: Path, name: str = MANIFEST) -> Manifest | None:
    """Read a folder's manifest; None where there is none that this program could have written.

    Only a regular file of at most ``LARGEST`` bytes is read. Raises ``OSError`` where it is there
    and can't be read.
    """
    path = folder / name
    try:
        found = path.lstat()
        if not stat.S_ISREG(found.st_mode) or found.st_size > LARGEST:
            return None
        # whatever takes its place meanwhile: no link is followed, no pipe waited for
        flags = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
        with open(os.open(path, os.O_RDONLY | flags), "rb") as file:
            return Manifest.model_validate_json(file.read(LARGEST), strict=True)
    except (FileNotFoundError, ValidationError):
        return None
