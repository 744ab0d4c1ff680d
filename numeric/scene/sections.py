"""Scenes: what a TOML file may say, checked before anything is computed.

Sections are validated by pydantic; every error names the key, the value and what is allowed.
Every number is the decimal as written, held as a fraction.
"""

import difflib
import tomllib
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Literal

from force_diffusion.numeric.arithmetic.decimals import decimal_string, exact, short
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

LARGEST_FILE = 64_000  # bytes of a scene file; far more than any scene needs
# Dots outside of whole-line comments: a dotted key makes a table a dot, in quadratic time.
MOST_DOTS = 200
Number = Annotated[Fraction, BeforeValidator(exact)]


class SceneError(ForceDiffusionError, ValueError):
    """Something in a scene is wrong: which key, what it says, and what is allowed."""

    def __init__(self, key: str, value: object, allowed: str) -> None:
        """Say all three."""
        shown = _shown(value)
        super().__init__(
            f"{key} = {shown}: {allowed}" if value is not None else f"{key}: {allowed}"
        )
        self.key, self.allowed = key, allowed


class Written(Decimal):
    """A decimal that remembers how it was written."""

    text: str

    def __new__(cls, text: str) -> "Written":
        """Keep the text."""
        number = super().__new__(cls, text)
        number.text = text
        return number

    def __repr__(self) -> str:
        return self.text


def _shown(value: object) -> str:
    if isinstance(value, Fraction):
        return decimal_string(value, None)
    if isinstance(value, int) and abs(value) > 10**40:
        return "a number of more than 40 digits"
    if isinstance(value, bool):
        text = str(value).lower()
    elif isinstance(value, Written):
        text = value.text
    else:
        try:
            text = f'"{value}"' if isinstance(value, str) else str(value).replace("'", '"')
        except (RecursionError, ValueError):  # nested deeply, or an integer of thousands of digits
            text = "…"
    return text if len(text) <= 60 else text[:57] + "…"


class Section(BaseModel):
    """A section: unknown keys are errors, types are not converted, nothing changes afterwards."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, strict=True, arbitrary_types_allowed=True
    )


class PackingSection(Section):
    """The ordered packing; width None is the infinite slab; spacing None is 3 r."""

    height: int = Field(ge=1, le=10_000_000)
    width: int | None = Field(default=None, ge=1, le=10**12)
    radius: Number = Fraction(1)
    spacing: Number | None = None
    allow_images: bool = False


class DisorderSection(Section):
    """The radii: drawn, with a relative standard deviation and a seed, or read from a file."""

    kind: Literal["uniform", "normal", "two-point", "file"]
    relative_std: Number | None = None
    seed: int = Field(default=0, ge=0, lt=2**64)
    file: str | None = None


class LoadSection(Section):
    """The load; angles in degrees from straight down, positive towards +i."""

    kind: Literal["surface", "bulk", "point", "file"] = "surface"
    magnitude: Number = Fraction(1)
    angle_deg: Number = Fraction(0)
    at: list[int] | None = None
    file: str | None = None


class EffectsSection(Section):
    """What is simulated of the packing, and whether tension stops the sweep."""

    geometry: Literal["ordered", "first-order", "exact"] = "exact"
    stop_at_tension: bool = False


Quantity = Literal[
    "contact",
    "contact_forces",
    "positions",
    "profile",
    "histogram",
    "response",
    "base_reactions",
]


class AskSection(Section):
    """The question."""

    quantity: Quantity
    at: list[int | str] | None = None
    tolerance: Number | None = None
    certified: bool = False
    realisations: int = Field(default=1, ge=1, le=10**9)
    bins: int | None = Field(default=None, ge=1, le=1_000_000)


class Scene(Section):
    """A whole scene, as read and checked; files are relative to ``folder``."""

    packing: PackingSection
    disorder: DisorderSection | None = None
    load: LoadSection = LoadSection()
    effects: EffectsSection = EffectsSection()
    ask: AskSection
    folder: Path = Path()

    @property
    def spacing(self) -> Fraction:
        """s; 3 r unless named."""
        given = self.packing.spacing
        return 3 * self.packing.radius if given is None else given

    @property
    def n_x(self) -> Fraction:
        """n_x = s/4r."""
        return self.spacing / (4 * self.packing.radius)

    @property
    def contact(self) -> tuple[int, int, str]:
        """The contact that is asked for, ``at = [i, j, "+"]``."""
        assert self.ask.at is not None
        i, j, branch = self.ask.at
        return int(i), int(j), str(branch)

    @property
    def site(self) -> tuple[int, int]:
        """The bead that is asked for, ``at = [i, j]``."""
        assert self.ask.at is not None
        i, j = self.ask.at
        return int(i), int(j)


def read_scene(path: Path) -> Scene:
    """Read and check a scene file. Raises ``SceneError``."""
    try:
        if not path.is_file():  # a device or a pipe may have no end
            why = "a scene must be an ordinary file" if path.exists() else "there is no such file"
            raise SceneError(str(path), None, why)
        with path.open("rb") as file:
            content = file.read(LARGEST_FILE + 1)
        text = content.decode("utf-8")
    except UnicodeDecodeError:
        raise SceneError(str(path), None, "a scene must be UTF-8 text") from None
    except OSError as error:
        raise SceneError(str(path), None, f"can't be read ({error.strerror})") from None
    if len(content) > LARGEST_FILE:
        raise SceneError(str(path), None, f"a scene has at most {LARGEST_FILE} bytes")
    return parse_scene(text, path.parent)


def parse_scene(text: str, folder: Path = Path()) -> Scene:
    """Check the text of a scene. Raises ``SceneError``.

    >>> parse_scene('packing = {height = 4}\\nask = {quantity = "profle"}')
    Traceback (most recent call last):
    ...
    force_diffusion.numeric.scene.sections.SceneError: ask.quantity = "profle": must be one of \
"contact", "contact_forces", "positions", "profile", "histogram", "response", "base_reactions"; \
did you mean "profile"?
    """
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    dots = sum(line.count(".") for line in lines)
    if dots > MOST_DOTS:
        allowed = f"at most {MOST_DOTS} outside of comments: keys are at most one section deep"
        raise SceneError("scene", None, f"has {dots} dots, {allowed}")
    try:
        raw = tomllib.loads(text, parse_float=Written)
    except (tomllib.TOMLDecodeError, ArithmeticError, RecursionError) as error:
        reason = "is nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise SceneError("scene", None, f"is no valid TOML: {reason}") from None
    except ValueError as error:  # an integer with thousands of digits
        raise SceneError("scene", None, f"is no valid TOML: {error}") from None
    if "folder" in raw:
        raise SceneError("folder", raw["folder"], _unknown("folder", Scene))
    try:
        scene = Scene.model_validate(raw)
    except ValidationError as error:
        raise _explained(error, raw) from None
    scene = scene.model_copy(update={"folder": folder})
    try:
        check(scene)
    except SceneError as error:  # say the number as it was written, not as it was understood
        section, _, key = error.key.partition(".")
        value = raw.get(section, {}).get(key)
        if not isinstance(value, Written):
            raise
        raise SceneError(error.key, value, error.allowed) from None
    return scene


def _fields(model: type[BaseModel]) -> list[str]:
    return [name for name in model.model_fields if name != "folder"]


def _unknown(key: str, model: type[BaseModel]) -> str:
    known = _fields(model)
    close = difflib.get_close_matches(key, known, n=1)
    hint = f'did you mean "{close[0]}"? ' if close else ""
    return f"is unknown; {hint}allowed are {', '.join(known)}"


# Forms of lists, whose elements say nothing when they are named alone.
_LISTS = {
    "load.at": "must be a bead, at = [k, l], of whole numbers",
    "ask.at": 'must be a contact, at = [i, j, "+"] or [i, j, "-"], or for positions a bead, '
    "at = [i, j]",
}


def _explained(error: ValidationError, raw: dict[str, Any]) -> SceneError:
    """Turn pydantic's first error into one line in the words of a scene."""
    first = error.errors()[0]
    path = [str(part) for part in first["loc"] if not str(part).startswith("function-")]
    key = ".".join(path[:2])
    kind, value, context = first["type"], first["input"], first.get("ctx", {})
    sections: dict[str, Any] = {
        "packing": PackingSection,
        "disorder": DisorderSection,
        "load": LoadSection,
        "effects": EffectsSection,
        "ask": AskSection,
    }
    if kind == "extra_forbidden":
        model = Scene if len(path) == 1 else sections[path[0]]
        return SceneError(key, None, _unknown(path[-1], model))
    if kind == "missing":
        what = f"the section [{key}]" if len(path) == 1 else f"the key {key}"
        return SceneError(key, None, f"{what} is required")
    if kind == "literal_error":
        section = sections[path[0]].model_fields[path[1]]
        allowed = [f'"{choice}"' for choice in _choices(section.annotation)]
        close = difflib.get_close_matches(f'"{value}"', allowed, n=1)
        hint = f"; did you mean {close[0]}?" if close else ""
        return SceneError(key, value, f"must be one of {', '.join(allowed)}{hint}")
    if key in _LISTS:
        return SceneError(key, raw[path[0]][path[1]], _LISTS[key])
    if kind == "value_error":
        return SceneError(key, value, str(context["error"]))
    if kind in {"model_type", "model_attributes_type", "dict_type"}:
        return SceneError(key, value, f"must be a section, written [{key}]")
    rule = first["msg"].lower().replace("input should", "must")
    if kind == "int_type":
        rule += ", written without point or exponent"
    return SceneError(key, value, rule)


def _choices(annotation: Any) -> tuple[str, ...]:
    return tuple(annotation.__args__)


def check(scene: Scene) -> None:
    """Check what keys say about each other. Raises ``SceneError``."""
    _check_packing(scene)
    _check_disorder(scene)
    _check_load(scene)
    _check_ask(scene)
    if scene.effects.stop_at_tension and scene.effects.geometry != "exact":
        raise SceneError(
            "effects.stop_at_tension", True, 'only has a meaning with geometry = "exact"'
        )
    if (
        scene.effects.stop_at_tension
        and scene.ask.quantity == "response"
        and scene.ask.realisations > 1
    ):
        raise SceneError(
            "effects.stop_at_tension",
            True,
            "can't be averaged: each realisation of a response would stop elsewhere",
        )


def _check_packing(scene: Scene) -> None:
    p = scene.packing
    if p.radius <= 0:
        raise SceneError("packing.radius", p.radius, "must be greater than 0")
    if not 4 * p.radius**2 < scene.spacing**2 < 12 * p.radius**2 or scene.spacing < 0:
        ratio = decimal_string(scene.spacing / p.radius, None)
        ratio = ratio if len(ratio) <= 45 else short(scene.spacing / p.radius)
        raise SceneError(
            "packing.spacing",
            scene.spacing,
            f"must lie strictly between 2 r and 2√3 r = 3.4641… r (it is {ratio} r), "
            "or beads of the ordered packing overlap",
        )
    if p.width is not None and p.width <= p.height and not p.allow_images:
        raise SceneError(
            "packing.width",
            p.width,
            f"must be greater than the height {p.height}, or contacts see their periodic images; "
            "say allow_images = true if a narrow periodic strip is meant, or leave width out "
            "for the infinite slab",
        )


def _check_disorder(scene: Scene) -> None:
    d = scene.disorder
    if d is None:
        return
    if d.kind == "file":
        if d.file is None:
            raise SceneError("disorder.file", None, 'is required with kind = "file"')
        for key in ("relative_std", "seed"):
            if key in d.model_fields_set:
                raise SceneError(
                    f"disorder.{key}", getattr(d, key), 'has no meaning with kind = "file"'
                )
        if scene.ask.realisations > 1:
            raise SceneError(
                "ask.realisations", scene.ask.realisations, "must be 1: a file holds one packing"
            )
        return
    if d.file is not None:
        raise SceneError("disorder.file", d.file, 'needs kind = "file"')
    if d.relative_std is None:
        raise SceneError("disorder.relative_std", None, f'is required with kind = "{d.kind}"')
    if d.relative_std < 0:
        raise SceneError("disorder.relative_std", d.relative_std, "must not be negative")
    if d.relative_std > 10**100:
        raise SceneError("disorder.relative_std", d.relative_std, "must be at most 1e100")
    reach = {"uniform": 3 * d.relative_std**2, "two-point": d.relative_std**2}.get(d.kind)
    if reach is not None and reach >= 1:
        below = "1/√3 = 0.57735…" if d.kind == "uniform" else "1"
        raise SceneError(
            "disorder.relative_std",
            d.relative_std,
            f"must be below {below}: {d.kind} disorder would reach a radius ≤ 0",
        )


def _check_load(scene: Scene) -> None:
    load = scene.load
    if load.magnitude <= 0:
        raise SceneError("load.magnitude", load.magnitude, "must be greater than 0")
    if abs(load.angle_deg) > 180:
        raise SceneError("load.angle_deg", load.angle_deg, "must lie between -180 and 180")
    if load.kind == "file":
        if load.file is None:
            raise SceneError("load.file", None, 'is required with kind = "file"')
        if load.angle_deg:
            raise SceneError("load.angle_deg", load.angle_deg, 'has no meaning with kind = "file"')
    elif load.file is not None:
        raise SceneError("load.file", load.file, 'needs kind = "file"')
    if load.kind == "point":
        if load.at is None:
            raise SceneError("load.at", None, 'is required with kind = "point", as at = [k, l]')
        if len(load.at) != 2:
            raise SceneError("load.at", load.at, "must be a bead, [k, l]")
        _check_site(scene, "load.at", load.at, scene.packing.height)
    elif load.at is not None:
        raise SceneError("load.at", load.at, 'needs kind = "point"')


def _check_site(scene: Scene, key: str, site: Any, highest: int) -> None:
    i, j = site[:2]
    width = scene.packing.width
    if (i + j) % 2:
        raise SceneError(key, site, "i + j must be even")
    if not 0 <= j <= highest:
        raise SceneError(key, site, f"j must be from 0 to {highest}")
    if (width is not None and not 0 <= i < 2 * width) or abs(i) >= 2**60:
        if width is None:
            raise SceneError(key, site, "i must be above -2^60 and below 2^60")
        raise SceneError(key, site, f"i must be from 0 to {2 * width - 1}")


def _check_ask(scene: Scene) -> None:
    ask, height = scene.ask, scene.packing.height
    if ask.tolerance is not None and not 0 < ask.tolerance < 1:
        raise SceneError("ask.tolerance", ask.tolerance, "must lie between 0 and 1")
    if (ask.bins is not None) and ask.quantity != "histogram":
        raise SceneError("ask.bins", ask.bins, 'needs quantity = "histogram"')
    _check_at(scene, height)
    if ask.quantity == "response" and scene.load.kind != "point":
        raise SceneError("load.kind", scene.load.kind, 'must be "point" for quantity = "response"')
    wide = ask.quantity in {"contact_forces", "base_reactions"} and scene.load.kind in {
        "surface",
        "bulk",
    }
    all_beads = ask.quantity in {"positions", "profile", "histogram"} and ask.at is None
    if scene.packing.width is None and (wide or all_beads):
        raise SceneError(
            "packing.width",
            None,
            f'is required: an infinite slab has infinitely many answers to "{ask.quantity}"',
        )


def _check_at(scene: Scene, height: int) -> None:
    ask = scene.ask
    forms = {"contact": 3, "histogram": 3, "positions": 2}
    if ask.at is None:
        if ask.quantity == "contact":
            raise SceneError(
                "ask.at", None, 'is required with quantity = "contact", as at = [i, j, "+"]'
            )
        return
    if ask.quantity not in forms:
        raise SceneError("ask.at", ask.at, f'has no meaning with quantity = "{ask.quantity}"')
    if forms[ask.quantity] == 3:
        if (
            len(ask.at) != 3
            or not all(isinstance(c, int) for c in ask.at[:2])
            or ask.at[2] not in {"+", "-"}
        ):
            raise SceneError(
                "ask.at",
                ask.at,
                'must be a contact, [i, j, "+"] or [i, j, "-"], (i, j) its lower bead',
            )
        _check_site(scene, "ask.at", ask.at, height - 1)
        return
    if len(ask.at) != 2 or not all(isinstance(c, int) for c in ask.at):
        raise SceneError("ask.at", ask.at, "must be a bead, [i, j]")
    _check_site(scene, "ask.at", ask.at, height)
