"""The output folder: written aside, then renamed into place, and never over others' files."""

import json
import os
import re
import shutil
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError

MANIFEST = "manifest.json"
DOCUMENT = "equations.tex"
PROGRAM = "force-diffusion"

_OURS = re.compile(
    r"eq\d\d\.tex|equations\.tex|manifest\.json|result\.json"
    r"|(cost|stability|figures)\.json|report\.html|[a-z_]{1,20}\.csv"
    r"|figure\d[a-z_]{0,20}\.csv|(figure\d|pf|chains|cost|stability)\.(png|svg|pdf)"
)
_LATEX_LEAVES = re.compile(r"equations\.(aux|log|out|pdf|synctex\.gz|fls|fdb_latexmk)")
_ASIDE = ".force-diffusion-"


class NotOurFolderError(ForceDiffusionError):
    """The folder holds files that this program did not write."""


def owned_files(folder: Path) -> set[str]:
    """Names that the folder's manifest lists as ours; none without a manifest of ours.

    The manifest is outside text: only plain names of the kind that this program writes count.
    """
    try:
        manifest = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):  # none there, or nothing of ours
        return set()
    if not isinstance(manifest, dict) or manifest.get("program") != PROGRAM:
        return set()
    listed = manifest.get("files")
    names = [name for name in listed if isinstance(name, str)] if isinstance(listed, list) else []
    return {name for name in names if _OURS.fullmatch(name)} | {MANIFEST}


def foreign_files(folder: Path) -> list[str]:
    """Names in the folder that are not ours, nor what LaTeX leaves beside our document."""
    owned = owned_files(folder)
    return sorted(
        path.name
        for path in folder.iterdir()
        if path.name not in owned
        and not (path.name.startswith(_ASIDE) and path.is_dir())
        and not (DOCUMENT in owned and _LATEX_LEAVES.fullmatch(path.name))
    )


def _of_another_run(aside: Path) -> bool:
    """Whether another process that still lives writes there; the name holds its number."""
    number = aside.name.removeprefix(_ASIDE)
    if not number.isdecimal() or int(number) == os.getpid():
        return False
    try:
        os.kill(int(number), 0)  # signal 0 only asks
    except PermissionError:  # it lives, under another user
        return True
    except (ProcessLookupError, OverflowError):
        return False
    return True


class OutputFolder:
    """A folder that can be written to; ``publish`` puts a whole set of files into it."""

    def __init__(self, folder: Path, aside: Path) -> None:
        """Take a folder and the place aside within it."""
        self.folder = folder
        self._aside = aside

    def publish(self, files: Mapping[str, str | bytes]) -> None:
        """Write every file aside, then rename them into place, dropping our older ones.

        At each moment every file in the folder is whole and the manifest owns all of them.
        """
        for name, content in files.items():
            try:
                if isinstance(content, bytes):
                    (self._aside / name).write_bytes(content)
                else:
                    (self._aside / name).write_text(content, encoding="utf-8")
            except OSError as failure:  # a write that fails half-way names no file
                failure.filename = str(self.folder / name)
                raise
        for name in owned_files(self.folder) - set(files):
            (self.folder / name).unlink(missing_ok=True)
        for name in sorted(files, key=lambda name: name != MANIFEST):
            os.replace(self._aside / name, self.folder / name)


@contextmanager
def output_folder(folder: Path) -> Iterator[OutputFolder]:
    """Make the folder and a place aside within it, or say at once why that can't be."""
    made = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    foreign = foreign_files(folder)
    if foreign:
        shown = ", ".join(foreign[:3]) + (", …" if len(foreign) > 3 else "")
        raise NotOurFolderError(shown)
    for left in folder.glob(f"{_ASIDE}*"):  # of a run that was killed
        if not _of_another_run(left):
            shutil.rmtree(left, ignore_errors=True)
    aside = folder / f"{_ASIDE}{os.getpid()}"
    aside.mkdir()
    try:
        yield OutputFolder(folder, aside)
    finally:
        shutil.rmtree(aside, ignore_errors=True)
        if made:
            with suppress(OSError):  # not empty: it was published
                folder.rmdir()
