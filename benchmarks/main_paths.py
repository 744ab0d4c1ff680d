"""The main paths of the package, as pieces of work whose instructions or times can be compared.

``python main_paths.py NAME…`` runs them one after the other, with a call of getppid() before and
after each: valgrind, told to dump its counts there, counts what lies between. ``regressions.py``
starts it so.
"""

import os
import sys
from collections.abc import Callable
from fractions import Fraction
from statistics import median
from time import perf_counter
from typing import Any

Work = Callable[[], Any]


def _proofs() -> Work:
    from force_diffusion.derivations.framework.loading import load
    from force_diffusion.derivations.framework.runner import proofs

    derivations = [load(11), load(13)]
    return lambda: [list(proofs(derivation)) for derivation in derivations]


def _sweep(height: int, width: int, bits: int | None = None) -> Work:
    from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls
    from peers import Problem

    return Problem(height, width).solver(FLOAT64 if bits is None else Balls(bits))


def _answer(quantity: str, packing: str = "height = 16\nwidth = 34", more: str = "") -> Work:
    """Plan a scene and run it, as the command ``run`` does."""
    from force_diffusion.numeric.planning.planner import plan
    from force_diffusion.numeric.run import run
    from force_diffusion.numeric.scene.reading import parse_scene
    from force_diffusion.numeric.scene.scene import Scene

    text = (
        f"[packing]\n{packing}\n[disorder]\nkind = 'uniform'\nrelative_std = 1e-6\n"
        f"[ask]\nquantity = '{quantity}'\n{more}\n"
    )
    return lambda: run(plan(parse_scene(text, Scene)))


def _line_sums() -> Work:
    contact = "at = [0, 100, '+']\n[effects]\ngeometry = 'first-order'"
    return _answer("contact", "height = 200", contact)


def _radii() -> Work:
    from force_diffusion.numeric.arithmetic.systems import FLOAT64
    from force_diffusion.numeric.disorder.radii import DrawnRadii, rows_of
    from force_diffusion.numeric.lattice.layers import whole

    rows = whole(256, 64).rows
    drawn = [DrawnRadii(kind, Fraction(1, 1000), 1, 256) for kind in ("uniform", "normal")]
    return lambda: [rows_of(radii, rows, [0, 1], FLOAT64) for radii in drawn]


def _closed_forms() -> Work:
    from force_diffusion.numeric import closed_forms

    phi, height = Fraction(-1, 8), 64

    def work() -> None:
        for number in (float, Fraction):
            for j in range(height):
                for form in (closed_forms.surface_variance, closed_forms.bulk_variance):
                    form(number(height), number(j), number(phi), number(1), number(1))

    return work


COUNTED: dict[str, Callable[[], Work]] = {
    "NumPy sweep, 32 × 66": lambda: _sweep(32, 66),
    "balls sweep, 50 digits, 8 × 18": lambda: _sweep(8, 18, 183),
    "radii, 65 layers of 256, twice two": _radii,
    "closed forms, 64 layers": _closed_forms,
    "scene: one contact by line sums": _line_sums,
    "scene: profile of 64 small packings": lambda: _answer(
        "profile", "height = 8\nwidth = 18", "realisations = 64"
    ),
}
"""Counted after a warm-up; names of sizes are layers × beads."""

PROOFS: dict[str, Callable[[], Work]] = {"proofs of Eqs. 11 and 13": _proofs}
"""Counted at their first run, since SymPy remembers; in a process of their own."""


def fast_ratio(rounds: int = 101) -> float:
    """Seconds of the compiled sweep over those of fixed NumPy arithmetic on as many beads.

    The arithmetic is 16 products, sums and roots of arrays of all beads. Both take turns, and the
    median of the rounds' ratios is given. Raises ``ImportError`` without numba.
    """
    import numpy as np
    from peers import Problem

    height, width = 256, 512
    solve = Problem(height, width).compiled(again=True)
    a, b = np.linspace(1, 2, (height + 1) * width), np.linspace(2, 3, (height + 1) * width)

    def reference() -> None:
        for _ in range(16):
            np.sqrt(a * b + a)

    ratios = []
    for turn in range(rounds + 2):
        start = perf_counter()
        solve()
        middle = perf_counter()
        reference()
        if turn >= 2:
            ratios.append((middle - start) / (perf_counter() - middle))
    return median(ratios)


def main(names: list[str]) -> None:
    """Run the named paths between marks."""
    if names == ["--fast-ratio"]:
        print(fast_ratio())
        return
    for name in names:
        work = (COUNTED | PROOFS)[name]()
        if name in COUNTED:
            work()
        os.getppid()
        work()
        os.getppid()


if __name__ == "__main__":
    main(sys.argv[1:])
