"""Exact packings as statements for Coq: the fractions that ``numeric.mechanics.taylor`` computes.

A packing with rational radii and direction cosines is solved as power series in ε by the sweeps of
``numeric/``. The statement says that the theory in Coq has the same values and slopes, as
fractions: displacements, contact directions, forces under a surface load, under weights and under a
load on one bead.
"""

from collections.abc import Iterable, Iterator
from fractions import Fraction

from force_diffusion.numeric.mechanics import taylor

from ..witnesses.draws import SmallPacking, draw
from .files import Companion, Statement

Expansion = list[Fraction]


def _fraction(value: Fraction) -> str:
    shown = f"{abs(value.numerator)}" + (f" / {value.denominator}" if value.denominator > 1 else "")
    return f"(- ({shown}))" if value < 0 else f"({shown})"


def _z(value: int) -> str:
    return f"({value})" if value < 0 else str(value)


def _expands(what: str, series: Expansion) -> str:
    return f"expands {what} {_fraction(series[0])} {_fraction(series[1])}"


def _claims(packing: SmallPacking) -> Iterator[str]:
    (across, layer), load = packing.loaded, _fraction(packing.load)
    contacts = dict.fromkeys(packing.contacts)
    solved = _solved(packing, packing.surface_load())
    for i, j in contacts:
        vectors = {f"delta_x X {i + 1} {j + 1}": solved.displacement(i + 1, j + 1)}
        for branch, sign in _BRANCHES:
            vectors[f"delta_n_{branch} G X {i} {j}"] = solved.direction(i, j, sign)
        for name, components in vectors.items():
            for axis, series in zip("xy", components, strict=True):
                yield _expands(f"(fun e => {axis}_of ({name} e))", series)
    yield _forces(f"surface {packing.height} {load}", solved, contacts)
    weights = {
        (i, j): (Fraction(0), -packing.load)
        for j in range(1, packing.height + 1)
        for i in range(j % 2, 2 * packing.width, 2)
    }
    yield _forces(f"bulk {load}", _solved(packing, weights), contacts)
    alone = _solved(packing, {packing.loaded: (Fraction(0), -packing.load)})
    period = 2 * packing.width  # Coq's packing is infinite, and has the one load
    nearest = {
        (i, j): i + period * round(Fraction(across - i, period)) for i, j in contacts if j < layer
    }
    yield _forces(
        f"single {across} {layer} {load}", alone, [(i, j) for (_, j), i in nearest.items()]
    )


_BRANCHES = (("plus", "+"), ("minus", "-"))


def _forces(load: str, solved: taylor.TaylorPacking, contacts: Iterable[taylor.Site]) -> str:
    claims = [
        _expands(f"(f_{branch} F {_z(i)} {j})", solved.force(i, j, sign))
        for i, j in contacts
        for branch, sign in _BRANCHES
    ]
    return f"(forall F, carries {solved.height} X ({load}) F ->\n    {_all(claims)})"


def _solved(
    packing: SmallPacking, loads: dict[taylor.Site, tuple[Fraction, Fraction]]
) -> taylor.TaylorPacking:
    return taylor.solve(
        packing.width, packing.height, n=packing.n, rho=packing.rho, loads=loads, order=1
    )


def _all(claims: Iterable[str]) -> str:
    return " /\\\n    ".join(claims)


def packing_statement(seed: int) -> Statement:
    """What Coq is asked about the packing that is drawn with a seed."""
    packing = draw(seed)
    radii = "; ".join(
        f"({i}%Z, {j}%Z, {_fraction(value)})" for (i, j), value in sorted(packing.rho.items())
    )
    rho = f"(periodic {2 * packing.width} [{radii}])"
    n_x, n_y = map(_fraction, packing.n)
    variables = "(G : lattice) (rho : radii) (X : centres)"
    hypotheses = (
        "r G = 1",
        f"n_x G = {n_x}",
        f"n_y G = {n_y}",
        f"rho = {rho}",
        f"packing G {packing.height} rho X",
    )
    return Statement(
        f"packing_{seed}",
        (f"  forall {variables},", *(f"  {one} ->" for one in hypotheses)),
        _all(_claims(packing)),
        "prove_packing",
        (
            Companion(
                "is_about_something",
                f"exists {variables},\n    {_all(hypotheses)}",
                f"destruct (lattice_exists {n_x} {n_y}) as [G ?]; [lra..|].\n"
                f"  exists G, {rho}, (laid_packing G {rho}). something; tauto.",
            ),
        ),
        theory="Fractions",
    )
