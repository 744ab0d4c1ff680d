"""How long closed forms take: each call in processes of its own, after all imports.

Run with ``python benchmarks/calculator.py``. Times are of the processor, the least of three
processes each, and include the proofs of what a call rests on; ``import sympy`` is measured in the
same processes. Exit status 1 when a target is missed.
"""

import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from time import process_time

from measuring import Line, program

ROWS = ("B7", "B8", "B21", "B22", "B23")
QUICK, SYMBOLIC = 0.25, 3  # seconds; with symbolic N, or below a point load
TARGETS = {
    'variance(f_plus(i, j) - f_minus(i, j), load="surface")': QUICK,
    'variance(mean_over(f_plus(i, j), N), load="bulk")': SYMBOLIC,
    'covariance(f_plus(i, j), f_plus(i + p, l), load="surface")': QUICK,
    "variance(response(i, j), load=point(k, l))": SYMBOLIC,
    "mean(f_plus(i, j), order=2, load=leaning(t))": QUICK,
    **dict.fromkeys(ROWS, SYMBOLIC),
}


def probe(call: str) -> str:
    """Seconds of the processor that ``import sympy`` and the call take in this process."""
    start = process_time()
    import sympy  # noqa: F401

    imported = process_time() - start
    from force_diffusion.derivations.framework.record import load

    import force_diffusion as fd
    from force_diffusion import symbols

    names = {name: getattr(fd, name) for name in dir(fd)} | vars(symbols)
    exact = load(call).exact if call in ROWS else None
    start = process_time()
    for form in exact().values() if exact else [eval(call, names)]:
        assert form.pieces
    return f"{imported} {process_time() - start}"


def calls() -> Iterator[Line]:
    """Each call, and what it is to ``import sympy``."""
    for call, target in TARGETS.items():
        asked = [sys.executable, __file__, "--probe", call]
        runs = [subprocess.check_output(asked, text=True).split() for _ in range(3)]
        imported, seconds = (min(map(float, column)) for column in zip(*runs, strict=True))
        yield Line(f"`{call}`", seconds, " s", "<", target)
        yield Line("  / import sympy", seconds / imported)


if __name__ == "__main__":
    probes = {call: partial(probe, call) for call in TARGETS}
    raise SystemExit(program(__doc__, "Closed forms", {"calls": calls}, probes))
