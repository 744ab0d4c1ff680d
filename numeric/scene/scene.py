"""A whole scene: checks across its keys, and the source that answers quote."""

import hashlib
import math
from fractions import Fraction
from pathlib import Path
from typing import Any, Self

from force_diffusion import __version__

from ..arithmetic.decimals import decimal_string, short
from ..lattice.branch import Branch, Contact, Site
from .combinations import NEEDS, Need, either, refusal
from .sections import PLACES, Ask, Disorder, Effects, GivenRadii, Load, Packing, SceneError, Section

PROGRAM = "force-diffusion"
FARTHEST = 10**307  # units of length, in which float64 are given


class CheckedScene(Section):
    """The sections of a scene, checked; files are relative to ``folder``. Raises ``SceneError``."""

    packing: Packing
    disorder: Disorder | None = None
    load: Load = Load()
    effects: Effects = Effects()
    ask: Ask
    folder: Path = Path()

    def __init__(self, /, **values: Any) -> None:
        """Check the sections, and what they say about each other."""
        super().__init__(**values)
        check(self)

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

    def asking(self, **changes: Any) -> Self:
        """Give the scene with changes of what it asks for."""
        return self.model_copy(update={"ask": self.ask.model_copy(update=changes)})


def check(scene: CheckedScene) -> None:
    """Check what keys say about each other. Raises ``SceneError``."""
    packing, disorder, load, ask = scene.packing, scene.disorder, scene.load, scene.ask
    _check_packing(packing)
    for need in NEEDS:
        _check_need(scene, need)
    refuse("run", scene)
    if isinstance(disorder, GivenRadii):
        _check_given(disorder, packing, ask)
    elif disorder is not None:
        _check_disorder(disorder, ask)
    if load.at is not None:
        _check_place(packing, "load.at", load.at, contact=False, layers=(1, packing.height))
    if scene.effects.contacts == "unilateral" and (packing.width or 3) < 3:
        allowed = 'must be 3 or more with contacts = "unilateral": beads move in a periodic strip'
        raise packing.wrong("width", allowed)
    if ask.at is not None:
        contact = ask.quantity != "positions"
        layers = (0, packing.height - contact)
        _check_place(packing, "ask.at", ask.at, contact=contact, layers=layers)
    _check_layers(ask, load, packing.height)


def _check_need(scene: CheckedScene, need: Need) -> None:
    """Refuse a key that means nothing beside what another says, and miss one that is needed."""
    section, _, name = need.key.partition(".")
    keys = getattr(scene, section)
    if keys is None:
        return
    says = keys.quantities if need.other == "quantity" else (getattr(keys, need.other),)
    value = getattr(keys, name) if name in keys.model_fields_set else None
    if value is None and any(word in need.required for word in says):
        form = ', as at = [i, j], or for a contact [i, j, "+"]' if name == "at" else ""
        raise keys.wrong(name, f'is required with {need.other} = "{says[0]}"{form}')
    if value is not None and not any(word in need.values for word in says):
        raise keys.wrong(name, f"needs {need.other} = {either(need.values)}")


def refuse(command: str, scene: CheckedScene, *, reach: bool = False) -> None:
    """Raise ``SceneError`` where a command does not answer what is combined here."""
    packing, effects, ask = scene.packing, scene.effects, scene.ask
    for quantity in ask.quantities:
        reason = refusal(
            command,
            quantity,
            dimension=packing.dimension,
            slab=packing.width is None,
            drawn=scene.disorder is not None and scene.disorder.kind not in {"file", "given"},
            load=scene.load.kind,
            contacts=effects.contacts,
            geometry=effects.geometry,
            at=ask.at is not None,
            layers=ask.layers is not None,
            several=ask.realisations > 1,
            together=len(ask.quantities) > 1,
            tolerance=ask.tolerance is not None,
            reach=reach,
        )
        if reason is not None:
            key, why = reason
            section, _, name = key.partition(".")
            raise SceneError(key, getattr(getattr(scene, section), name, None), why)


def _check_packing(p: Packing) -> None:
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
        raise p.wrong(
            "width",
            f"must be greater than the height {p.height}, or contacts see their periodic images; "
            "say allow_images = true if a narrow periodic strip is meant"
            + (", or leave width out for the infinite slab" if flat else ""),
        )


def _check_place(
    packing: Packing, key: str, at: Any, *, contact: bool, layers: tuple[int, int]
) -> None:
    """Check a bead in these layers, or a contact by its lower bead."""
    d = packing.dimension
    bead, branches = at[:d], "+-" if d == 2 else "123"
    whole = len(at) == d + contact and all(isinstance(number, int) for number in bead)
    if not whole or (contact and at[-1] not in list(branches)):
        raise SceneError(key, at, f"must be {PLACES[d, contact]}")
    if why := packing.misplaced(bead, *layers):
        raise SceneError(key, at, why)


def _check_given(given: GivenRadii, packing: Packing, ask: Ask) -> None:
    shape, wanted, rank = given.values.shape, packing.shape, packing.dimension
    if shape[-rank:] != wanted or len(shape) not in (rank, rank + 1):
        beads = " × ".join(map(str, wanted[1:]))
        raise given.wrong(
            given.name,
            f"an array of shape {shape}; the packing has {wanted[0]} layers, base included, of "
            f"{beads} beads: give {wanted}, or (packings, …) for several",
        )
    if not 1 <= packing.radius * FARTHEST <= FARTHEST**2:
        allowed = "must lie between 1e-307 and 1e307 with an array of float64: choose another unit"
        raise packing.wrong("radius", allowed)
    mean = float(given.values.mean()) - (packing.radius if given.delta_r is None else 0)
    if abs(mean) > packing.radius / 2:
        allowed = f"must be near the mean radius of the beads, which differs from it by {mean:.3g}"
        raise packing.wrong("radius", allowed)
    packings = shape[0] if len(shape) > rank else 1
    if ask.realisations > packings:
        raise ask.wrong("realisations", f"must be at most {packings}: so many are given")


def _check_disorder(d: Disorder, ask: Ask) -> None:
    if d.kind == "file":
        if ask.realisations > 1:
            raise ask.wrong("realisations", "must be 1: a file holds one packing")
        return
    assert d.relative_std is not None
    if d.relative_std > 10**100:
        raise d.wrong("relative_std", "must be at most 1e100")
    reach = {"uniform": 3 * d.relative_std**2, "two-point": d.relative_std**2}.get(d.kind, 0)
    if reach >= 1:
        below = "1/√3 = 0.57735…" if d.kind == "uniform" else "1"
        allowed = f"must be below {below}: {d.kind} disorder would reach a radius ≤ 0"
        raise d.wrong("relative_std", allowed)


def _check_layers(ask: Ask, load: Load, height: int) -> None:
    """Check the layers that a response or a histogram is asked of."""
    if ask.layers is None:
        return
    top = height if load.at is None else int(load.at[-1])
    if not ask.layers or len(set(ask.layers)) < len(ask.layers):
        raise ask.wrong("layers", "must be one layer or several, each once")
    if not all(0 <= j < top for j in ask.layers):
        allowed = f"must be layers of lower beads below the load, from 0 to {top - 1}"
        raise ask.wrong("layers", allowed)


def files_read(scene: CheckedScene) -> dict[str, str]:
    """Give the SHA-256 of the bytes of the files of radii and loads, as they are now."""
    radii = None if scene.disorder is None else scene.disorder.file
    files = {"disorder.file": radii, "load.file": scene.load.file}
    return {key: sha256(scene.folder / file) for key, file in files.items() if file is not None}


def source_of(scene: CheckedScene, files: dict[str, str] | None = None) -> dict[str, Any]:
    """Give program, version, scene, seed (null where nothing is drawn) and SHA-256 of what is read.

    Numbers of the scene are strings, exact. ``sha256`` is that of the ``files_read``, and of the
    doubles of an array, in the order of its rows.
    """
    sections = {
        name: {key: _exact(value) for key, value in section if value is not None}
        for name, section in scene
        if name != "folder" and section is not None
    }
    sections["packing"]["spacing"] = _exact(scene.packing.s)
    disorder, hashes = scene.disorder, dict(files_read(scene) if files is None else files)
    if isinstance(disorder, GivenRadii):
        sections["disorder"] = {"kind": "given", disorder.name: list(disorder.values.shape)}
        hashes[f"disorder.{disorder.name}"] = hashlib.sha256(disorder.values.tobytes()).hexdigest()
    drawn = disorder is not None and disorder.kind not in {"file", "given"}
    if disorder is not None and not drawn:
        sections["disorder"].pop("seed", None)
    return {
        "program": PROGRAM,
        "version": __version__,
        "scene": sections,
        "seed": disorder.seed if drawn and disorder is not None else None,
        "sha256": hashes,
    }


def sha256(path: Path) -> str:
    """Give the SHA-256 of a file that was read before."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _exact(value: Any) -> Any:
    if not isinstance(value, Fraction):
        return value
    shown = decimal_string(value)
    return shown if Fraction(shown) == value else str(value)
