"""A whole scene, what its keys say about each other, and how answers say where they came from."""

import hashlib
import math
from fractions import Fraction
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from ..arithmetic.decimals import decimal_string, short
from ..lattice.branch import Axis, Branch, Contact, Site
from .combinations import refusal
from .sections import (
    Ask,
    Disorder,
    Effects,
    GivenRadii,
    Load,
    Packing,
    SceneError,
    Section,
    Sections,
)

PROGRAM = "force-diffusion"
FARTHEST = 10**307  # units of length, in which float64 are given


class Scene(Sections):
    """A whole scene; files are relative to ``folder``. Raises ``SceneError``."""

    folder: Path = Path()

    def __init__(self, /, **values: Any) -> None:
        """Check the sections, and what they say about each other."""
        super().__init__(**values)
        check(self)

    @property
    def spacing(self) -> Fraction:
        """s; 3 r unless named."""
        return self.packing.s

    @property
    def n_x(self) -> Fraction:
        """n_x = s/4r."""
        return self.packing.s / (4 * Fraction(self.packing.radius))

    @property
    def contact(self) -> Contact | None:
        """The one contact of two dimensions that is asked for, or None."""
        if self.ask.at is None or self.ask.quantity == "positions" or self.packing.dimension > 2:
            return None
        i, j, branch = self.ask.at
        return Contact(int(i), int(j), Branch(branch))

    @property
    def site(self) -> Site | None:
        """The one bead of two dimensions that is asked for, or None."""
        if self.ask.at is None or self.ask.quantity != "positions" or self.packing.dimension > 2:
            return None
        i, j = self.ask.at
        return int(i), int(j)


def check(scene: Sections) -> None:
    """Check what keys say about each other. Raises ``SceneError``."""
    packing, disorder, ask = scene.packing, scene.disorder, scene.ask
    _check_packing(packing)
    refuse("run", scene)
    if isinstance(disorder, GivenRadii):
        _check_given(disorder, packing, ask)
    elif disorder is not None:
        _check_disorder(disorder, ask)
    _check_load(scene.load, packing)
    _check_ask(ask, packing)
    _check_layers(ask, scene.load, packing.height)
    _check_effects(scene.effects, packing)


def refuse(command: str, scene: Sections, *, reach: bool = False) -> None:
    """Raise ``SceneError`` where a command does not answer what is combined here."""
    packing, load, effects, ask = scene.packing, scene.load, scene.effects, scene.ask
    found = refusal(
        command=command,
        quantity=ask.quantity,
        dimension=packing.dimension,
        slab=packing.width is None,
        drawn=scene.disorder is not None and scene.disorder.kind not in {"file", "given"},
        load=load.kind,
        leaning=bool(load.angle_deg),
        contacts=effects.contacts,
        geometry=effects.geometry,
        at=ask.at is not None,
        layers=ask.layers is not None,
        bins=ask.bins is not None,
        several=ask.realisations > 1,
        tolerance=ask.tolerance is not None,
        reach=reach,
    )
    if found is not None:
        section, _, key = found.key.partition(".")
        value = getattr(getattr(scene, section), key, None)
        raise SceneError(found.key, value, found.why)


def _check_effects(effects: Effects, packing: Packing) -> None:
    if effects.contacts == "bilateral":
        for key in ("most_programs", "most_seconds"):
            if key in effects.model_fields_set:
                allowed = 'only has a meaning with contacts = "unilateral"'
                raise SceneError(f"effects.{key}", getattr(effects, key), allowed)
        return
    if effects.most_seconds is not None and effects.most_seconds <= 0:
        raise SceneError("effects.most_seconds", effects.most_seconds, "must be greater than 0")
    if packing.width is not None and packing.width < 3:
        raise SceneError(
            "packing.width",
            packing.width,
            'must be 3 or more with contacts = "unilateral": beads move in a periodic strip',
        )


def _check_packing(p: Packing) -> None:
    if p.radius <= 0:
        raise SceneError("packing.radius", p.radius, "must be greater than 0")
    flat, widest = p.dimension == 2, 8 + Fraction(8, p.dimension)  # −1/d < φ = 1 − s²/8r² < 1/2
    if not 4 * p.radius**2 < p.s**2 < widest * p.radius**2 or p.s < 0:
        most = f"{math.sqrt(widest):.6f}"[:6]
        ratio = decimal_string(p.s / p.radius)
        ratio = ratio if len(ratio) <= 15 else f"about {short(p.s / p.radius)}"
        raise SceneError(
            "packing.spacing",
            p.s,
            f"must lie strictly between 2 r and {'2√3 r = ' if flat else ''}{most}… r "
            f"(it is {ratio} r), or beads of the ordered packing overlap",
        )
    if p.width is not None and p.width <= p.height and not p.allow_images:
        raise SceneError(
            "packing.width",
            p.width,
            f"must be greater than the height {p.height}, or contacts see their periodic images; "
            "say allow_images = true if a narrow periodic strip is meant"
            + (", or leave width out for the infinite slab" if flat else ""),
        )


def _check_bead(packing: Packing, key: str, at: Any, highest: int) -> None:
    """Check a bead (p, q, j)."""
    if len(at) < 3 or not all(isinstance(number, int) for number in at[:3]):
        raise SceneError(key, at, "must begin with a bead, [p, q, j], in three dimensions")
    if not 0 <= at[2] <= highest:
        raise SceneError(key, at, f"j must be from 0 to {highest}")
    assert packing.width is not None
    if not all(0 <= number < packing.width for number in at[:2]):
        raise SceneError(key, at, f"p and q must be from 0 to {packing.width - 1}")


def _check_given(given: GivenRadii, packing: Packing, ask: Ask) -> None:
    shape, rank = given.values.shape, packing.dimension
    wanted = packing.shape
    if shape[-rank:] != wanted or len(shape) not in (rank, rank + 1):
        beads = " × ".join(map(str, wanted[1:]))
        raise SceneError(
            f"disorder.{given.name}",
            None,
            f"an array of shape {shape}; the packing has {wanted[0]} layers, base included, of "
            f"{beads} beads: give {wanted}, or (packings, …) for several",
        )
    if not 1 <= packing.radius * FARTHEST <= FARTHEST**2:
        allowed = (
            "must lie between 1e-307 and 1e307 beside an array of float64: choose another unit"
        )
        raise SceneError("packing.radius", packing.radius, allowed)
    mean = float(given.values.mean()) - (packing.radius if given.delta_r is None else 0)
    if abs(mean) > packing.radius / 2:
        raise SceneError(
            "packing.radius",
            packing.radius,
            f"must be near the mean radius of the beads, which differs from it by {mean:.3g}",
        )
    packings = shape[0] if len(shape) > rank else 1
    if ask.realisations > packings:
        raise SceneError(
            "ask.realisations", ask.realisations, f"must be at most {packings}: so many are given"
        )


def _check_disorder(d: Disorder, ask: Ask) -> None:
    if d.kind == "file":
        if d.file is None:
            raise SceneError("disorder.file", None, 'is required with kind = "file"')
        for key in ("relative_std", "seed"):
            if key in d.model_fields_set:
                raise SceneError(
                    f"disorder.{key}", getattr(d, key), 'has no meaning with kind = "file"'
                )
        if ask.realisations > 1:
            raise SceneError(
                "ask.realisations", ask.realisations, "must be 1: a file holds one packing"
            )
        return
    if d.file is not None:
        raise SceneError("disorder.file", d.file, 'needs kind = "file"')
    if d.relative_std is None:
        raise SceneError("disorder.relative_std", None, f'is required with kind = "{d.kind}"')
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


def _check_load(load: Load, packing: Packing) -> None:
    if load.magnitude <= 0:
        raise SceneError("load.magnitude", load.magnitude, "must be greater than 0")
    if abs(load.angle_deg) > 180:
        raise SceneError("load.angle_deg", load.angle_deg, "must lie between -180 and 180")
    if load.kind == "file":
        if load.file is None:
            raise SceneError("load.file", None, 'is required with kind = "file"')
    elif load.file is not None:
        raise SceneError("load.file", load.file, 'needs kind = "file"')
    if load.kind == "point":
        if load.at is None:
            raise SceneError("load.at", None, 'is required with kind = "point", as at = [k, l]')
        if len(load.at) != packing.dimension:
            form = "[k, l]" if packing.dimension == 2 else "[p, q, l]"
            raise SceneError("load.at", load.at, f"must be a bead, {form}")
        _check_load_site(packing, load.at)
    elif load.at is not None:
        raise SceneError("load.at", load.at, 'needs kind = "point"')


def _check_load_site(packing: Packing, at: Any) -> None:
    if not 1 <= at[-1] <= packing.height:
        allowed = f"j must be from 1, above the base, to {packing.height}, the surface"
        raise SceneError("load.at", at, allowed)
    (_check_site if packing.dimension == 2 else _check_bead)(packing, "load.at", at, packing.height)


def _check_site(packing: Packing, key: str, site: Any, highest: int) -> None:
    i, j = site[:2]
    width = packing.width
    if (i + j) % 2:
        raise SceneError(key, site, "i + j must be even")
    if not 0 <= j <= highest:
        raise SceneError(key, site, f"j must be from 0 to {highest}")
    if (width is not None and not 0 <= i < 2 * width) or abs(i) >= 2**60:
        if width is None:
            raise SceneError(key, site, "i must be above -2^60 and below 2^60")
        raise SceneError(key, site, f"i must be from 0 to {2 * width - 1}")


def _check_ask(ask: Ask, packing: Packing) -> None:
    if ask.tolerance is not None and not 0 < ask.tolerance < 1:
        raise SceneError("ask.tolerance", ask.tolerance, "must lie between 0 and 1")
    _check_at(ask, packing)


def _check_layers(ask: Ask, load: Load, height: int) -> None:
    """Check the layers that a response or a histogram is asked of."""
    if ask.layers is None:
        return
    top = height if load.at is None else int(load.at[-1])
    if not ask.layers or len(set(ask.layers)) < len(ask.layers):
        raise SceneError("ask.layers", ask.layers, "must be one layer or several, each once")
    if not all(0 <= j < top for j in ask.layers):
        allowed = f"must be layers of lower beads below the load, from 0 to {top - 1}"
        raise SceneError("ask.layers", ask.layers, allowed)


def _check_at(ask: Ask, packing: Packing) -> None:
    forms = {"contact": 3, "histogram": 3, "positions": 2}
    if ask.at is None:
        if ask.quantity == "contact":
            raise SceneError(
                "ask.at", None, 'is required with quantity = "contact", as at = [i, j, "+"]'
            )
        return
    if packing.dimension > 2:
        _check_at_axes(ask, packing)
        return
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
        _check_site(packing, "ask.at", ask.at, packing.height - 1)
        return
    if len(ask.at) != 2 or not all(isinstance(c, int) for c in ask.at):
        raise SceneError("ask.at", ask.at, "must be a bead, [i, j]")
    _check_site(packing, "ask.at", ask.at, packing.height)


def _check_at_axes(ask: Ask, packing: Packing) -> None:
    contact = ask.quantity == "contact"
    assert ask.at is not None
    if len(ask.at) != 3 + contact or (contact and ask.at[-1] not in list(Axis)):
        form = 'a contact, [p, q, j, "1"], "2" or "3", (p, q, j) its lower bead'
        form = form if contact else "a bead, [p, q, j]"
        raise SceneError("ask.at", ask.at, f"must be {form}, in three dimensions")
    _check_bead(packing, "ask.at", ask.at, packing.height - contact)


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
    shown = decimal_string(value)
    return shown if Fraction(shown) == value else str(value)
