"""What a scene may say: its sections, as TOML has them and as Python users construct them.

Every number is exact: the decimal as written, held as a fraction; of a Python float, the decimal
that Python prints for it.
"""

import operator
import textwrap
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, get_args, get_origin

import numpy as np
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from ..arithmetic.decimals import decimal_string, exact, short
from ..arithmetic.errors import ForceDiffusionError, WrongTypeError, rule, suggestion
from ..arithmetic.systems import Array
from .combinations import QUANTITIES

# Of numbers that are doubles: sums of as many as a memory holds stay finite.
LARGEST = 1e300
MOST_REALISATIONS = 10**9


class SceneError(ForceDiffusionError, ValueError):
    """A scene is wrong: the message gives the key, its value, and what is allowed."""

    def __init__(self, key: str, value: object, allowed: str) -> None:
        """Say all three."""
        shown = "" if value is None else f" = {_shown(value)}"
        super().__init__(f"{textwrap.shorten(key, 200, placeholder='…')}{shown}: {allowed}")
        self.key, self.value, self.allowed = key, value, allowed


def _shown(value: object) -> str:
    """Quote a value by at most 60 characters."""
    match value:
        case bool():
            text = str(value).lower()
        case int() if abs(value) > 10**40:
            return "a number of more than 40 digits"
        case Fraction():
            text = decimal_string(value)
        case str():
            text = f'"{value}"'
        case list() | tuple():
            text = f"[{', '.join(map(_shown, value[:20]))}]"
        case dict():
            return "a table"
        case _:
            text = str(value)
    return text if len(text) <= 60 else text[:57] + "…"


def _whole(value: object) -> object:
    """Take NumPy's integers, too."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        return value
    return operator.index(value)


Whole = Annotated[int, BeforeValidator(_whole)]


def _questions(value: object) -> object:
    """Take one quantity, or a list of them."""
    asked = value if isinstance(value, list | tuple) else [value]
    for name in asked:
        if name not in QUANTITIES:
            raise _no_choice("ask.quantity", name, QUANTITIES)
    if not asked or len(set(asked)) < len(asked):
        raise SceneError("ask.quantity", value, "must be one quantity, or several, each once")
    return asked[0] if len(asked) == 1 else tuple(asked)


Questions = Annotated[Any, BeforeValidator(_questions)]
Number = Annotated[Any, BeforeValidator(exact)]
if TYPE_CHECKING:  # what may be given; held is the type below
    Bead = Any
    Place = Any
    Layers = Any
else:
    _listed = BeforeValidator(lambda at: list(at) if isinstance(at, tuple) else at)
    Bead = Annotated[list[int], _listed]
    Place = Annotated[list[int | str], _listed]
    Layers = Annotated[list[Whole], _listed]


class Section(BaseModel):
    """A section: unknown keys are errors, types are not converted, nothing changes afterwards.

    Raises ``SceneError``, which names the key, its value and what is allowed.
    """

    # built when it is first used: most commands need few sections
    model_config = ConfigDict(
        extra="forbid", frozen=True, strict=True, arbitrary_types_allowed=True, defer_build=True
    )
    section: ClassVar[str] = ""

    def __init__(self, /, *unnamed: Any, **values: Any) -> None:
        """Check the values."""
        if unnamed:
            names = "=…, ".join(type(self).model_fields)
            raise WrongTypeError(f"{type(self).__name__} takes its fields by name: {names}=…")
        try:
            super().__init__(**values)
        except ValidationError as error:
            raise explained(error, type(self), values) from None

    def wrong(self, name: str, allowed: str) -> SceneError:
        """Give the error that says what is allowed of a key; an array is not shown."""
        value = getattr(self, name)
        shown = None if isinstance(value, np.ndarray) else value
        return SceneError(f"{self.section}.{name}", shown, allowed)

    def __repr__(self) -> str:
        said = {name: getattr(self, name) for name in self.model_fields_set}
        shown = [f"{name}={_brief(said[name])}" for name in type(self).model_fields if name in said]
        return f"{type(self).__name__}({', '.join(shown)})"


def _brief(value: object) -> str:
    """Show a value by at most 200 characters."""
    if isinstance(value, Fraction):
        return short(value)
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    return textwrap.shorten(repr(value), 200, placeholder="…")


class Packing(Section):
    """The ordered packing: M = ``height`` layers above the base, of W = ``width`` beads each.

    If ``width`` is None, it is the infinite slab. ``radius`` is r, and ``spacing`` is s, the
    distance between neighbours in a layer, 2 r < s < 2√3 r, by default 3 r; both in the same unit
    of length. ``allow_images`` allows periodic strips as narrow as W ≤ M.

    With ``dimension`` 3 each sphere rests on three others, a layer holds W × W of them and is
    periodic in both directions, and 2 r < s < √(32/3) r.
    """

    section = "packing"
    height: Whole = Field(ge=1, le=10_000_000)
    width: Whole | None = Field(default=None, ge=1, le=10**12)
    radius: Number = Field(default=Fraction(1), gt=0)
    spacing: Number | None = None
    dimension: Whole = Field(default=2, ge=2, le=3)
    allow_images: bool = False

    @property
    def s(self) -> Fraction:
        """s; by default 3 r."""
        return 3 * Fraction(self.radius) if self.spacing is None else Fraction(self.spacing)

    @property
    def n_x(self) -> Fraction:
        """n_x = s/4r."""
        return self.s / (4 * Fraction(self.radius))

    @property
    def shape(self) -> tuple[int | None, ...]:
        """The shape of an array of its beads: (M + 1, W), or in three dimensions (M + 1, W, W)."""
        return (self.height + 1, *[self.width] * (self.dimension - 1))

    def misplaced(self, bead: Sequence[int], lowest: int, highest: int) -> str:
        """Say why the packing has no bead of that name in these layers; an empty text if it has."""
        *columns, j = bead
        if not lowest <= j <= highest:
            if lowest:
                return f"j must be from {lowest}, above the base, to {highest}, the surface"
            return f"j must be from 0 to {highest}"
        if self.dimension == 2 and sum(bead) % 2:
            return "i + j must be even"
        names, beads = ("i", 2) if self.dimension == 2 else ("p and q", 1)
        if self.width is None and not abs(columns[0]) < 2**60:
            return "i must be above -2^60 and below 2^60"
        if self.width is not None and not all(0 <= n < beads * self.width for n in columns):
            return f"{names} must be from 0 to {beads * self.width - 1}"
        return ""


class Disorder(Section):
    """The radii: drawn, with a relative standard deviation σ/r and a seed, or read from a file."""

    section = "disorder"
    kind: Literal["uniform", "normal", "two-point", "file"]
    relative_std: Number | None = Field(default=None, ge=0)
    seed: Whole = Field(default=0, ge=0, lt=2**64)
    file: str | None = Field(default=None, max_length=1000)


def radii_array(value: object) -> Array:
    """Hold a copy of an array of finite numbers."""
    if isinstance(value, np.ndarray) and hasattr(value, "mask"):  # numpy.ma takes long to load
        raise ValueError("must have no masked entries: fill them in")
    try:
        given = np.asarray(value)
        if given.dtype.kind not in "iuf":  # no text, no times, no truth values, nothing complex
            raise ValueError
    except ValueError:
        raise ValueError(
            "must be an array of real numbers, all rows equally long; round numbers of other "
            "types, such as Fractions, by .astype(float)"
        ) from None
    with np.errstate(all="ignore"):
        values = np.array(given, dtype=np.float64)
        cut = values.astype(given.dtype) != given
    if not values.size:
        raise ValueError(f"is empty: its shape is {values.shape}")
    if not 2 <= values.ndim <= 4:
        raise ValueError(
            "must be an array of shape (layers, W) or, of spheres, (layers, W, W); with an axis "
            "before it for several packings"
        )
    good = np.abs(values) <= LARGEST  # or sums overflow
    if not good.all():
        at = tuple(np.argwhere(~good)[0].tolist())
        place = f"[{', '.join(map(str, at))}]"
        if np.isfinite(values[at]):
            raise ValueError(f"must hold numbers of at most {LARGEST:g}, and {place} is larger")
        raise ValueError(f"must hold finite numbers, and {place} is not")
    if cut.any():
        raise ValueError(
            f"has {given.dtype} numbers that float64 would cut: round them by .astype(float)"
        )
    values.setflags(write=False)
    return values


class GivenRadii(Disorder):
    """Your own radii, as an array: of ``radii`` themselves or of their deviations ``delta_r``.

    Shape (layers, W), layer 0 (the base) first, or (packings, layers, W) for several packings;
    lengths in the unit of ``packing.radius``. Column q of layer j is the bead i = 2q + j mod 2. In
    three dimensions (layers, W, W), where [j, p, q] is bead (p, q, j), or (packings, layers, W, W).
    Floats are taken as the exact numbers that they are. A scene file names a file of radii instead.
    """

    kind: Literal["given"] = "given"  # type: ignore[assignment]
    radii: Annotated[Any, BeforeValidator(radii_array)] = None
    delta_r: Annotated[Any, BeforeValidator(radii_array)] = None

    def __init__(self, /, *unnamed: Any, **values: Any) -> None:
        """Check that one of the two is given."""
        super().__init__(*unnamed, **values)
        if (self.radii is None) == (self.delta_r is None):
            raise SceneError("disorder", None, "give either radii or delta_r")

    @property
    def name(self) -> str:
        """Which of the two is given."""
        return "radii" if self.delta_r is None else "delta_r"

    @property
    def values(self) -> Array:
        """What is given."""
        return np.asarray(getattr(self, self.name))


class Load(Section):
    """The load; angles in degrees from straight down, positive towards +i (for spheres, +x).

    ``kind``: "surface" (on every bead of layer M), "bulk" (on every bead), "point" (on the bead
    ``at`` = (k, l)) or "file" (``file`` lists i, j, fx, fy; for spheres, whose beads are (p, q, j),
    it lists p, q, j, fx, fy, fz). ``magnitude`` is the load on a bead.
    """

    section = "load"
    kind: Literal["surface", "bulk", "point", "file"] = "surface"
    magnitude: Number = Field(default=Fraction(1), gt=0)
    angle_deg: Number = Field(default=Fraction(0), ge=-90, le=90)
    at: Bead | None = None
    file: str | None = Field(default=None, max_length=1000)


class SurfaceLoad(Load):
    """A load on every bead of the surface, j = M (Eq. 13)."""

    kind: Literal["surface"] = "surface"


class BulkLoad(Load):
    """A load on every bead, its weight (Eq. 14)."""

    kind: Literal["bulk"] = "bulk"


class PointLoad(Load):
    """A load on the one bead ``at`` = (k, l) (Eqs. 6 to 10 and 16)."""

    kind: Literal["point"] = "point"


class Effects(Section):
    """Which effects are simulated.

    ``contacts``: "bilateral" contacts stay closed and may pull. "unilateral" contacts open instead,
    and a sequence of linear programs moves the beads until no contact pulls. The run gives up after
    ``most_programs`` of them, by default 400, or after ``most_seconds`` of processor time.
    """

    section = "effects"
    geometry: Literal["ordered", "first-order", "exact"] = "exact"
    contacts: Literal["bilateral", "unilateral"] = "bilateral"
    most_programs: Whole | None = Field(default=None, ge=1)
    most_seconds: Number | None = Field(default=None, gt=0)


class Ask(Section):
    """The question, or several; ``at``: a contact (i, j, "+" or "-"), for positions a bead (i, j).

    ``layers`` limits a response or a histogram to contacts whose lower beads lie in these layers.
    """

    section = "ask"
    quantity: Questions
    at: Place | None = None
    tolerance: Number | None = Field(default=None, gt=0, lt=1)
    certified: bool = False
    realisations: Whole = Field(default=1, ge=1, le=MOST_REALISATIONS)
    bins: Whole | None = Field(default=None, ge=1, le=1_000_000)
    layers: Layers | None = None

    @property
    def quantities(self) -> tuple[str, ...]:
        """All the questions."""
        return (self.quantity,) if isinstance(self.quantity, str) else self.quantity


OF_IMAGES = ("origin", "rotation", "scale", "y_down")
"""What ``read_radii`` takes, and no scene."""


def unknown(key: str, model: type[Section]) -> str:
    """Say what a key could have meant."""
    known = [name for name in model.model_fields if name != "folder"]
    if model.section == "disorder" and key in OF_IMAGES:
        return f"is for images: fd.read_radii(path, {key}=…) puts their beads on the lattice"
    hint = suggestion(f'"{key}"', [f'"{name}"' for name in known])
    return f"is unknown; {hint}allowed are {', '.join(known)}"


# What others call what a key may be.
_OTHERWISE = {"gaussian": "normal", "gauss": "normal", "bidisperse": "two-point"}
# How a bead, or with True a contact, is written in so many dimensions.
PLACES = {
    (2, False): "a bead, [i, j]",
    (2, True): 'a contact, [i, j, "+"] or [i, j, "-"], (i, j) its lower bead',
    (3, False): "a bead, [p, q, j], in three dimensions",
    (3, True): 'a contact, [p, q, j, "1"], "2" or "3", in three dimensions',
}
# Forms of lists, whose elements say nothing when they are named alone.
_LISTS = {
    "load.at": f"must be {PLACES[2, False]}, or {PLACES[3, False]}",
    "ask.layers": "must be a list of layers, such as layers = [0, 10], of whole numbers",
    "ask.at": f"must be {PLACES[2, True]}; for positions {PLACES[2, False]}; or {PLACES[3, True]}",
}


def _no_choice(key: str, value: object, choices: tuple[str, ...]) -> SceneError:
    """Say which words are allowed, and which could have been meant."""
    allowed = [f'"{choice}"' for choice in choices]
    meant = _OTHERWISE.get(value.lower(), value) if isinstance(value, str) else value
    hint = suggestion(_shown(meant), allowed)
    return SceneError(key, value, f"must be one of {', '.join(allowed)}; {hint}".rstrip("; "))


def explained(error: ValidationError, model: type[Section], values: dict[str, Any]) -> SceneError:
    """Turn pydantic's first error into one line in the words of a scene."""
    errors = error.errors()
    # a required key that is missing may be one that is misspelt
    first = next((each for each in errors if each["type"] == "extra_forbidden"), errors[0])
    kind, value, context = first["type"], first["input"], first.get("ctx", {})
    within = context.get("error")
    if isinstance(within, SceneError):  # of a section within this one
        return within
    name = str(first["loc"][0])
    key = f"{model.section}.{name}" if model.section else name
    if kind == "extra_forbidden":
        return SceneError(key, None, unknown(name, model))
    if kind == "missing":
        what = f"the key {key}" if model.section else f"the section [{key}]"
        field = model.model_fields[name].annotation
        choices = get_args(field) if get_origin(field) is Literal else ()
        allowed = f": {', '.join(choices)}" if choices else ""
        return SceneError(key, None, f"{what} is required{allowed}")
    if kind == "literal_error":
        return _no_choice(key, value, get_args(model.model_fields[name].annotation))
    if key in _LISTS:
        return SceneError(key, values[name], _LISTS[key])
    if kind in {"model_type", "model_attributes_type", "dict_type"}:
        return SceneError(key, value, f"must be a section, written [{key}]")
    bounds = model.model_fields[name].metadata
    low, high = ([getattr(b, side) for b in bounds if hasattr(b, side)] for side in ("ge", "le"))
    if low and high and kind in {"greater_than_equal", "less_than_equal"}:
        return SceneError(key, value, f"must be from {low[0]} to {high[0]}")
    return SceneError(key, value, rule(error))
