"""The sweep compiled: ``local`` recorded, and ``loops`` around it; bitwise that of ``sweep``.

The source that is compiled is put together when it is first needed, from what is recorded and from
``loops``, and lies in a file whose name is made from its content: so machine code that was kept of
an earlier run is taken only where nothing of what it was made from has changed. ``passes`` calls
them. A packing out of the ordinary (a bead that can't rest, a number that is not finite) is given
back, and left to ``sweep``, whose errors name the bead.
"""

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic import compiling
from ..arithmetic.carried import CARRYING, Carried
from ..arithmetic.compiling import CODES
from ..arithmetic.recording import Code, module, positive_root
from ..arithmetic.systems import FLOAT64, Array
from ..disorder.radii import relative
from . import defects, local
from .local import RESOLUTION

FINITE = "abs({0}) < inf"
POSITIVE = "{0} > 0) & ({0} < inf"
# Zeros in memory, for beads that are not there: a run of such is no longer.
NONE = 32
# Numbers that are looked at together, in the nearest cache.
MOST = 512


class Kernels(NamedTuple):
    """The compiled loops of one dimension."""

    runs: Callable[..., int]
    deposit: Callable[..., bool]
    straight_down: Callable[..., None]
    sweep_down: Callable[..., bool]
    settle: Callable[..., None]
    gaps: Callable[..., float]
    relative: Callable[..., bool]
    relative_errors: Callable[..., bool]
    scaled: Callable[..., bool]
    scaled_errors: Callable[..., bool]


def source(dimension: int) -> str:
    """Put together the source of all kernels of one dimension."""
    names = f"D, NONE, RESOLUTION, TOGETHER = {dimension}, {NONE}, {RESOLUTION!r}, {MOST}"
    loops = Path(__file__).with_name("loops.py").read_text(encoding="utf-8")
    recorded = [
        _rest(dimension),
        _rest_errors(dimension),
        _balance(dimension),
        _balance_errors(dimension),
        _gap(dimension),
    ]
    for carried in (False, True):
        recorded += [_order(dimension, carried=carried), _relative(carried=carried)]
        recorded.append(_scaled(carried=carried))
    imports = (
        "from math import inf, sqrt\nfrom force_diffusion.numeric.arithmetic.compiling import "
        "alone, fma, pitch, placed, taken"
    )
    # what compiles them has no part in the text, but in what comes of it
    with_what = hashlib.sha256(Path(compiling.__file__).read_text(encoding="utf-8").encode())
    loops = f"{loops}\n# compiled as said in {with_what.hexdigest()[:24]}"
    return module(recorded, f"{loops}\n\n{imports}\n{names}", Kernels._fields)


LOADED: set[int] = set()
"""Dimensions whose loops are compiled in this process."""


@lru_cache(maxsize=4)
def kernels(dimension: int) -> Kernels:
    """Give the compiled loops; what an earlier run compiled is kept where that is possible."""
    text = source(dimension)
    name = f"force_diffusion_sweeps_{hashlib.sha256(text.encode()).hexdigest()[:24]}"
    found = ModuleType(name)
    found.__file__ = _kept(text, name)
    made = Path(found.__file__).parent.glob(f"__pycache__/{name}.sweep_down*")
    if not any(made) and sys.stderr is not None and sys.stderr.isatty():
        print("compiling the sweeps for this machine, once: about 4 s", file=sys.stderr, flush=True)
    sys.modules[name] = found  # machine code that was kept asks for it
    LOADED.add(dimension)
    exec(compile(text, found.__file__, "exec"), vars(found))
    return Kernels(*(vars(found)[field] for field in Kernels._fields))


def _kept(text: str, name: str) -> str:
    """Lay a source down where the compiler keeps what it made of it; give the file's name."""
    path = CODES / f"{name}.py"
    with suppress(OSError):
        if not path.exists():
            CODES.mkdir(parents=True, exist_ok=True)
            handle, made = tempfile.mkstemp(dir=CODES)
            with open(handle, "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(made, path)
    return str(path)


class _Recording:
    """Names of quantities of beads, and of constants, that carry errors or not.

    ``arrays`` says how many quantities each array has, whose errors lie behind them. Code of
    numbers that carry errors fills in these alone, once the values are there.
    """

    def __init__(self, name: str, arrays: dict[str, int], constants: int, *, carried: bool) -> None:
        name += "_errors" * carried
        self.code, self.carried, self.arrays = Code(name, list(arrays)), carried, arrays
        self.constants: list[Any] = [self.code.constant() for _ in range(constants)]
        if carried:
            self.constants = [Carried(one, self.code.constant()) for one in self.constants]

    def take(self, array: str, row: int, place: int) -> Any:
        """Give a quantity of the beads at a place of the run."""
        value = self.code.takes(array, row, place)
        if not self.carried:
            return value
        return Carried(value, self.code.takes(array, self.arrays[array] + row, place))

    def several(self, array: str, first: int, count: int, place: int) -> tuple[Any, ...]:
        """Give quantities that lie one behind the other."""
        return tuple(self.take(array, first + k, place) for k in range(count))

    def values(self, array: str, first: int, count: int, place: int) -> tuple[Any, ...]:
        """Give such quantities without their errors."""
        return tuple(self.code.takes(array, first + k, place) for k in range(count))

    def turns(self, d: int, place: int) -> list[tuple[Any, ...]]:
        """Give δn of the contacts below the beads at a place."""
        return [self.several("block", d + a * d, d, place) for a in range(d)]

    def give(self, array: str, first: int, place: int | None, found: Sequence[Any]) -> None:
        """Put quantities there, or their errors."""
        behind = self.arrays[array] if self.carried else 0
        for row, one in enumerate(found, first + behind):
            error = one.error if isinstance(one, Carried) else one
            self.code.gives(array, row, place, error)


def _sqrt(value: Any) -> Any:
    return value.sqrt()


def _supported(of: _Recording, d: int) -> tuple[Any, ...]:
    """Give what a bead rests on, as ``local.rest`` takes it."""
    own, *supports = range(1 + d)
    under = [of.several("block", 0, d, place) for place in supports]
    rho_under = tuple(of.take("rho", 0, place) for place in supports)
    return under, of.take("rho", 0, own), rho_under, local.Metric(*of.constants)


def _rest(d: int) -> Code:
    of = _Recording("rest", {"rho": 1, "block": d + d * d}, 3, carried=False)
    under, rho, rho_under, m = _supported(of, d)
    found = local.rest(under, rho, rho_under, m, _sqrt, linear=False)
    for value in (1 + rho, *found.holds):
        of.code.demand(value, POSITIVE)
    of.give("block", 0, 0, [*found.c, *(x for v in found.dn for x in v)])
    return of.code


def _rest_errors(d: int) -> Code:
    of = _Recording("rest", {"rho": 1, "block": d + d * d}, 3, carried=True)
    c, *dn = (of.values("block", row, d, 0) for row in range(0, d + d * d, d))
    moved, off = defects.rest_errors(c, dn, *_supported(of, d))
    of.give("block", 0, 0, [*moved, *(x for v in off for x in v)])
    return of.code


def _borne(of: _Recording, d: int) -> list[tuple[Any, ...]]:
    """Give what the contacts above a bead bear, and their δn."""
    ups = range(3, 3 * (d + 1), 3)
    turns = [of.several("block", d + a * d, d, up + 1) for a, up in enumerate(ups)]
    return [(of.take("F", a, up), of.take("g", a, up), turns[a]) for a, up in enumerate(ups)]


def _balance(d: int) -> Code:
    of = _Recording("balance", {"F": d, "block": d + d * d, "g": d, "lost": d}, 0, carried=False)
    own, here, new = range(3)
    above = [(*one, of.take("lost", a, 3 * a + 5)) for a, one in enumerate(_borne(of, d))]
    F, dn = of.several("F", 0, d, own), of.turns(d, here)
    found = local.balance(above, F, dn, linear=False, compensated=True)
    of.code.demand(found.det * found.det, POSITIVE)
    for value in found.g:
        of.code.demand(value, FINITE)
    of.give("g", 0, own, found.g)
    of.give("lost", 0, new, found.lost)
    return of.code


def _balance_errors(d: int) -> Code:
    of = _Recording("balance", {"F": d, "block": d + d * d, "g": d}, 0, carried=True)
    own, here = range(2)
    F, dn = of.several("F", 0, d, own), of.turns(d, here)
    of.give("g", 0, own, defects.balance_errors(of.values("g", 0, d, own), _borne(of, d), F, dn))
    return of.code


def _order(d: int, *, carried: bool) -> Code:
    """Loads go straight down: ordered forces, of the same runs as ``_balance``."""
    of = _Recording("order", {"F": d, "shares": d}, 0, carried=carried)
    of.give("F", 0, 0, [of.take("F", a, 3 * (a + 1)) + of.take("shares", a, 0) for a in range(d)])
    return of.code


def _gap(d: int) -> Code:
    of = _Recording("gap", {"rho": 1, "block": d, "gaps": 1}, 5 + d, carried=False)
    here, there = (of.several("block", 0, d, place) for place in range(2))
    rho, other = (of.take("rho", 0, place) for place in range(2))
    phi, own, cross, *steps, square, excess = of.constants
    found = local.gap(steps, square, excess, local.less(there, here), rho + other,
                      local.Metric(phi, own, cross), positive_root)  # fmt: skip
    of.give("gaps", 0, None, [found])
    return of.code


def _relative(*, carried: bool) -> Code:
    of = _Recording("relative", {"radii": 1, "rho": 1}, 2, carried=carried)
    radii = of.code.takes("radii", 0, 0)
    of.give("rho", 0, 0, [relative(Carried(radii) if carried else radii, *of.constants)])
    return of.code


def _scaled(*, carried: bool) -> Code:
    of = _Recording("scaled", {"radii": 1, "rho": 1}, 1, carried=carried)
    deviates = of.code.takes("radii", 0, 0)
    of.give("rho", 0, 0, [(Carried(deviates) if carried else deviates) * of.constants[0]])
    return of.code


@lru_cache(maxsize=4)
def constants(dimension: int, phi: Fraction, *, carried: bool) -> Array:
    """Give what the ordered packing decides, as kernels take it."""
    m = local.metric(dimension, phi, (CARRYING if carried else FLOAT64).scalar)
    return numbers(m, carried=carried)


def numbers(of: Sequence[Any], *, carried: bool) -> Array:
    """Give numbers as kernels take them, their errors behind all values."""
    flat = [one.value for one in of] + [one.error for one in of] if carried else list(of)
    return np.array(flat, dtype=np.float64)
