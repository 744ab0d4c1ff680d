"""The paper's question: does a single negative force set off a cascade of rearrangements?

In each packing σ is raised, with the same deviates, to where the first contact loses its force, and
by a millionth more: exactly one contact then pulls, by about 1e-6 of the load. Contacts become
unilateral, the beads move until none pulls, and what has changed is counted. All of it is measured,
in float64; nothing here is proved.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from fractions import Fraction
from itertools import count, islice
from typing import Any, Literal

import numpy as np

from ... import tables
from ...arithmetic.errors import ForceDiffusionError
from ...figures.specification import Picture
from ...mechanics.problem import Problem
from ...mechanics.work import Work
from ...planning.planner import plan
from ...scene.scene import Scene
from ...scene.sections import Ask, BulkLoad, Disorder, Effects, Packing, SurfaceLoad
from ...unilateral import UnfinishedError
from ..study import Study
from .cascade_plot import picture

Protocol = Literal["linear-programs", "event-driven"]
LOADS = {"surface": SurfaceLoad, "bulk": BulkLoad}
# σ/r is known to this share of itself; tension of about this size is left.
JUST = Fraction(1, 10**6)
# Forces that change by more than these shares of the mean force are counted, and beads that move
# further than this, in units of r.
CHANGES, MOVED = (0.01, 0.1), 1e-3
SHARES = ("of_critical", "layer", "forces_1", "forces_10", "moved", "new", "events")
HEAD = (
    "One contact pulls by a millionth of the load, and opens; means over packings, ± two "
    "standard errors.\nShares: forces that changed by more than 1 % and 10 % of the mean, beads "
    "that moved, contacts that are new."
)


@dataclass(frozen=True)
class Cascade:
    """One packing before and after; shares are between 0 and 1.

    ``relative_std``: σ/r at which the first contact loses its force; ``of_critical``: M/M* there;
    ``layer``: j/M of that contact. Packings whose beads overlap before any contact pulls are left
    out, so that ``packing``, which is also the seed, may leave gaps. ``forces_1``, ``forces_10``:
    contacts, of those before or after, whose force changed by more than 1 % and 10 % of the mean
    force. ``moved``: beads that moved by more than 1e-3 r, rattlers left out. ``new``: contacts
    that were none before.
    """

    load: str
    height: int
    width: int
    packing: int
    relative_std: float
    of_critical: float
    layer: float
    forces_1: float
    forces_10: float
    moved: float
    new: float
    events: int


@dataclass(frozen=True)
class CascadeStudy(Study):
    """What opened contacts changed, packing by packing; which did not come to rest, and why."""

    cascades: tuple[Cascade, ...]
    protocol: str
    left_out: tuple[str, ...] = ()
    name = "cascade"

    def rows(self) -> list[tables.Row]:
        """A row a packing, ready for a data frame."""
        return [asdict(one) for one in self.cascades]

    def summary(self) -> list[tables.Row]:
        """Mean and standard error of each share, by load and height."""
        groups: dict[tuple[Any, ...], list[Cascade]] = {}
        for one in self.cascades:
            groups.setdefault((one.load, one.height, one.width), []).append(one)
        return [
            {"load": load, "height": height, "width": width, "packings": len(group)}
            | _summed(group)
            for (load, height, width), group in groups.items()
        ]

    def data(self) -> dict[str, Any]:
        """Give what JSON can hold."""
        return {"protocol": self.protocol, "summary": self.summary(), "packings": self.rows()}

    def picture(self) -> Picture:
        """Say what is drawn: the shares over the height."""
        return picture(self.summary())

    def __str__(self) -> str:
        """Give the summary as a table."""
        shown = [
            {name: row[name] for name in ("load", "height", "width", "packings")}
            | {name: f"{row[name]:.3f} ± {2 * row[f'{name}_error']:.3f}" for name in SHARES}
            for row in self.summary()
        ]
        return "\n".join([HEAD, *tables.text_table(shown), *self.left_out])

    __repr__ = __str__


def _summed(group: Sequence[Cascade]) -> tables.Row:
    row: tables.Row = {}
    for name in SHARES:
        values = np.array([getattr(one, name) for one in group], dtype=float)
        row[name] = float(values.mean())
        row[f"{name}_error"] = float(values.std(ddof=1) / np.sqrt(len(values)))
    return row


def cascade(
    notice: Callable[[str], None] = lambda _: None,
    *,
    heights: Sequence[int] = (8, 12, 16),
    packings: int = 16,
    protocol: Protocol = "linear-programs",
) -> CascadeStudy:
    """Open one contact that barely pulls, and count what changes.

    For each of ``heights`` M, under a surface and a bulk load, ``packings`` strips of width 2M with
    uniform disorder and s = 3 r. By default a minute. ``notice`` is told of every packing. Raises
    ``ForceDiffusionError`` for heights below 2 or fewer than two packings.

    >>> import force_diffusion as fd
    >>> found = fd.cascade(heights=[4], packings=2, protocol="event-driven")
    >>> len(found.rows()), bool(found.arrays["events"].min() > 0)
    (4, True)
    """
    if packings < 2 or not heights or min(heights) < 2:
        raise ForceDiffusionError("a cascade needs two packings or more, and heights from 2 on")
    if protocol not in ("linear-programs", "event-driven"):
        raise ForceDiffusionError(
            f'there is no protocol "{protocol}"; there are "linear-programs" and "event-driven"'
        )
    found: list[Cascade] = []
    left_out: list[str] = []
    for load in LOADS:
        for height in heights:
            each = _all_opened(load, height, protocol, left_out)
            for number, one in enumerate(islice(each, packings), start=1):
                notice(f"cascade: {load} load, M = {height}, {number} of {packings}")
                found.append(one)
    return CascadeStudy(tuple(found), protocol, tuple(left_out))


def _problem(load: str, height: int, number: int, std: Fraction, protocol: Protocol) -> Problem:
    scene = Scene(
        packing=Packing(height=height, width=2 * height),
        disorder=Disorder(kind="uniform", relative_std=std, seed=number),
        load=LOADS[load](),
        effects=Effects(contacts="unilateral", protocol=protocol),
        ask=Ask(quantity="contact_forces"),
    )
    return plan(scene).problem


def _all_opened(
    load: str, height: int, protocol: Protocol, left_out: list[str]
) -> Iterator[Cascade]:
    """Give packing after packing, but those in which beads overlap before any contact pulls.

    Those in which beads do not come to rest are ``left_out``, too, with the reason.
    """
    for number in count():
        try:
            found = _opened(load, height, number, protocol)
        except UnfinishedError as error:
            left_out.append(f"{load} load, M = {height}, packing {number} is left out: {error}")
            continue
        if found is not None:
            yield found


def _opened(load: str, height: int, number: int, protocol: Protocol) -> Cascade | None:
    """Find σ, open the contact, and compare."""
    from ...unilateral import balanced, settle, start

    def begun(std: Fraction) -> Any:
        """Give the packing with all contacts bilateral; no contacts where there is none."""
        grains, supports, overlaps = start(_problem(load, height, number, std, protocol), 0)
        return grains, None if overlaps else supports

    low, high = Fraction(0), Fraction(1, 2)
    while high - low > JUST / 10 * high:
        middle = ((low + high) / 2).limit_denominator(10**12)
        grains, supports = begun(middle)
        if supports is not None and balanced(grains, supports).min() > 0:
            low = middle
        else:
            high = middle
    std = high * (1 + JUST)
    grains, supports = begun(std)
    if supports is None:
        return None
    before = balanced(grains, supports)
    settled = settle(_problem(load, height, number, std, protocol), 0, Work())
    if settled is None:
        return None
    after = balanced(settled.grains, settled.contacts, settled.backbone)
    width = 2 * height
    old = dict(zip(map(tuple, supports.tolist()), before, strict=True))
    new = dict(zip(map(tuple, settled.contacts.tolist()), after, strict=True))
    change = np.array([abs(new.get(pair, 0.0) - old.get(pair, 0.0)) for pair in old | new])
    mean = float(before.mean())
    moves = np.hypot(*(settled.grains.x - grains.x)[settled.backbone].T)
    return Cascade(
        load, height, width, number,
        relative_std=float(std),
        of_critical=height * float(std) ** (2 / 3),
        layer=int(supports[int(before.argmin())][1]) // width / height,
        forces_1=float((change > CHANGES[0] * mean).mean()),
        forces_10=float((change > CHANGES[1] * mean).mean()),
        moved=float((moves > MOVED).mean()),
        new=sum(pair not in old for pair in new) / len(new),
        events=settled.events,
    )  # fmt: skip
