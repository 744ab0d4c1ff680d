"""The command ``examples``."""

from importlib.resources import files
from pathlib import Path
from typing import Annotated

import typer

from .guard import say
from .output import Output, Overwrite, folder_of

STATUSES = "Exit status: 0 copied; 2 the folder exists; 3 the disk failed; 130 interrupted."


def examples(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Where to copy them.", parser=folder_of)
    ],
    overwrite: Overwrite = False,
) -> None:
    """Copy the example scenes into a new folder."""
    scenes = {
        file.name: file.read_bytes()
        for file in files("force_diffusion.scenes").iterdir()
        if file.is_file() and not file.name.endswith(".py")
    }
    Output(folder, scenes, overwrite).write(scenes)
    for name in sorted(scenes):
        say(str(folder / name))
