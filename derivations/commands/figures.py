"""The command ``figures``: a thin layer over ``fd.figure``."""

import json
from collections.abc import Callable, Collection
from enum import StrEnum
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from force_diffusion.numeric.arithmetic.decimals import parse
from force_diffusion.numeric.arithmetic.errors import printable, quoted
from force_diffusion.numeric.figures.names import (
    FIGURES,
    HEIGHTS,
    KINDS,
    MODELS,
    OF_ENSEMBLES,
    OF_MODELS,
    OWN_SPACING,
    OWN_STD,
)
from force_diffusion.numeric.scene.combinations import answered, either

import force_diffusion as fd

from .guard import about, say
from .output import Output, Overwrite, out_option
from .shared import Json, command_line, noticing, sourced, warn

if TYPE_CHECKING:
    from force_diffusion.numeric.figures.catalogue import PaperFigure

STATUSES = (
    "Exit status: 0 drawn; 2 wrong usage or input; 3 matplotlib is missing, the disk failed, or "
    "memory ran out; 130 interrupted."
)


class SimplerModel(StrEnum):
    """A simpler model that may be drawn beside a figure."""

    Q_MODEL = "q-model"
    DOUBLE_Y = "double-y"


def _heights(text: str) -> tuple[int, ...]:
    """Read heights from outside text: whole numbers between commas."""
    try:
        return tuple(map(int, text.split(",")))
    except ValueError:
        raise typer.BadParameter(
            f"{quoted(text)}: give whole numbers with commas between them, such as 32,128."
        ) from None


def _number(text: str) -> Fraction:
    """Read a decimal from outside text."""
    try:
        return parse(text)
    except ValueError as error:
        raise typer.BadParameter(f"{error}.") from None


def _decimal(metavar: str, words: str) -> Any:
    """An option that takes a decimal."""
    return typer.Option(metavar=metavar, parser=_number, help=words)


def _figure(word: str) -> str:
    """Read the name of a figure, or of a scene's file."""
    if word not in FIGURES and not word.endswith(".toml"):
        raise typer.BadParameter(
            f"There is no figure '{printable(word)}'. Give any of {', '.join(FIGURES)}, or a "
            "scene, FILE.toml."
        )
    return word


def figures(
    which: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="WHICH",
            parser=_figure,
            help=f"Figures: {', '.join(FIGURES)}; by default all. Or your own scene, FILE.toml, "
            f"that asks for {either(answered('figures'))}; of spheres for "
            f"{either(answered('figures', dimension=3))}.",
        ),
    ] = None,
    out: Annotated[Path, out_option("PNG, SVG, PDF and CSV")] = Path("figures"),
    heights: Annotated[
        Collection[int] | None,
        typer.Option(
            metavar="M,M...",
            parser=_heights,
            help=f"Heights of figure 3; {','.join(map(str, HEIGHTS))} by default.",
        ),
    ] = None,
    realisations: Annotated[
        int | None,
        typer.Option(
            metavar="N",
            help="Packings of each ensemble; by default "
            + ", ".join(f"{FIGURES[name].realisations} in {name}" for name in OF_ENSEMBLES)
            + ".",
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            metavar="N", min=0, max=2**63 - 1, help="Seed of the radii; a scene has its own. [1]"
        ),
    ] = None,
    beside: Annotated[
        list[SimplerModel] | None,
        typer.Option(
            "--with",
            metavar="MODEL",
            help="Add the simpler model: q-model to figure 3, double-y to 4.",
        ),
    ] = None,
    spacing: Annotated[
        Fraction | None,
        _decimal("S", f"s/r of figures {', '.join(OWN_SPACING)}; 3 by default."),
    ] = None,
    relative_std: Annotated[
        Fraction | None,
        _decimal("X", f"σ/r of figures {', '.join(OWN_STD)}, instead of the defaults."),
    ] = None,
    as_json: Json = False,
    overwrite: Overwrite = False,
) -> None:
    """Draw the paper's figures from new simulations of exact packings."""
    wanted = list(dict.fromkeys(which or FIGURES))
    scenes = [name for name in wanted if name not in FIGURES]
    options: dict[str, tuple[Any, tuple[str, ...]]] = {
        "heights": (heights, ("3",)),
        "realisations": (realisations, OF_ENSEMBLES),
        "spacing": (spacing, OWN_SPACING),
        "relative_std": (relative_std, OWN_STD),
    }
    given = {key: option for key, option in options.items() if option[0] is not None}
    models = {f"with {model}": (model, (MODELS[model],)) for model in beside or ()}
    for key, (_, those) in {**given, **models}.items():
        if not set(those) & set(wanted):
            add = those[0] if len(those) == 1 else "one of them"
            raise typer.BadParameter(
                f"goes with figure{'s' * (len(those) > 1)} {', '.join(those)} only; add {add}"
                + (", or change the scene." if scenes else "."),
                param_hint=f"--{key.replace('_', '-')}",
            )
    if seed is not None and scenes == wanted:
        raise typer.BadParameter(
            "is for the paper's figures; a scene has disorder.seed instead.", param_hint="--seed"
        )
    stems = [FIGURES[name].file if name in FIGURES else Path(name).stem for name in wanted]
    if len(set(stems)) < len(stems):
        raise typer.BadParameter(
            "several figures would be written to the same files; give the scenes other names.",
            param_hint="WHICH",
        )
    import force_diffusion.numeric.figures.style  # noqa: F401  or leave before anything is solved

    possible = {*stems, *(figure.file for figure in FIGURES.values())}
    own_files = (f"{stem}.{kind}" for stem in possible for kind in (*KINDS, "json", "csv"))
    folder = Output(out, [*own_files, *(f"{table}.csv" for table in OF_MODELS.values())], overwrite)
    data: dict[str, Any] = {"command": command_line(), "figures": {}}
    files: dict[str, str | bytes] = {}
    for name, stem in zip(wanted, stems, strict=True):
        with noticing() as notice, about(Path(name).name if name in scenes else f"figure {name}"):
            if name in scenes:
                made = _own(Path(name), data["command"], notice)
            else:
                own = {key: value for key, (value, those) in given.items() if name in those}
                own["beside"] = [model for model in beside or () if MODELS[model] == name]
                own["seed"] = 1 if seed is None else seed
                made = fd.figure(name, notice=notice, command=data["command"], **own)
        entry = {"title": made.title, "files": list(made.files), "says": made.lines, **made.facts}
        data["figures"][name] = entry
        text = json.dumps({"command": data["command"], **entry}, indent=2, allow_nan=False)
        files |= {**made.files, f"{stem}.json": text + "\n"}
    folder.write(files)
    if as_json:
        print(json.dumps(data, indent=2))
        return
    for name, figure in data["figures"].items():
        say(f"{name}: {out / figure['files'][0]}")
        print("\n".join(f"  {line}" for line in figure["says"]))


def _own(path: Path, command: str, notice: Callable[[str], None]) -> "PaperFigure":
    """Answer a scene, and draw the answer; a question that has no figure raises ``SceneError``."""
    from force_diffusion.numeric.figures import style
    from force_diffusion.numeric.figures.catalogue import PaperFigure
    from force_diffusion.numeric.run.outcome import outcome_lines
    from force_diffusion.numeric.scene.scene import refuse
    from force_diffusion.numeric.tables import csv_bytes

    scene, name = fd.read_scene(path), path.stem
    refuse("figures", scene)
    notice(f"{name}: solving")
    result = scene.run()
    warn(path, result.plan.notes)
    title = f"{printable(name)}: {scene.ask.quantity}"
    notice(f"{name}: drawing")
    files: dict[str, str | bytes] = {
        **style.images(result.plot(), name, title, command, KINDS),
        f"{name}.csv": f"# {title}\n# {command}\n".encode() + csv_bytes(result.text),
    }
    about = result.data(rows=False)
    about["source"] = sourced(about["source"], path, None)
    return PaperFigure(title, files, {"answer": about}, outcome_lines(about))
