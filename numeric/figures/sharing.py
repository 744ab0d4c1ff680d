"""Figure B15: what the load of either branch gives to f⁺ in the mean, at order σ².

The points are Taylor coefficients of exact, nonlinear packings, one bead enlarged after the other,
as fractions: they have no error. The curves are Eq. B15, which is linear in t = L⁻/L⁺.
"""

from fractions import Fraction
from itertools import product

from .. import closed_forms
from . import specification as spec
from .packings import Notice, Options
from .stress import DIRECTIONS, HEIGHT, Direction, cosine, drawn, enlarged, row

ZERO, ONE = Fraction(0), Fraction(1)
CASES = list(product(DIRECTIONS, "+-"))


def theory(n: Direction, sign: str) -> list[Fraction]:
    """By layer, in units of (σ/r)²: of L⁺ what f⁺ has less L⁺, or what it has of L⁻ (Eq. B15)."""
    form = closed_forms.surface_mean_shift_at_angle
    own, both = (
        [form(HEIGHT, j, t, cosine(n), ONE, ONE) for j in range(HEIGHT)] for t in (ZERO, ONE)
    )
    return own if sign == "+" else [b - a for a, b in zip(own, both, strict=True)]


def measured(n: Direction, sign: str, notice: Notice) -> list[Fraction]:
    """The same from the order ε² of exact packings, summed over the bead that is enlarged."""
    found, across = [ZERO] * HEIGHT, -n[0] if sign == "+" else n[0]
    what = f"figure B15, φ = {cosine(n)}, load along n{sign}"
    for _, solved in enlarged(n, (across, -n[1]), (HEIGHT,), notice, what):
        for j in range(HEIGHT):
            found[j] += sum((solved.force(*site, "+")[2] for site in row(j)), ZERO)
    return found


def name(n: Direction, sign: str) -> str:
    """Name a case in the legend."""
    return rf"$L^{sign}$ at $\phi={float(cosine(n)):g}$, Taylor"


def figure(o: Options) -> spec.Figure:
    """Changes over M, against z."""
    found = {case: measured(*case, o.notice) for case in CASES}
    agree = all(values == theory(*case) for case, values in found.items())
    rows = [
        (float(cosine(n)), sign, j, float(value), float(exact))
        for (n, sign), values in found.items()
        for j, (value, exact) in enumerate(zip(values, theory(n, sign), strict=True))
    ]
    dashes = {"+": "-", "-": ":"}
    panel = spec.Panel(
        [
            *(
                drawn(found[n, sign], theory(n, sign), c, name(n, sign), dashes[sign])
                for c, (n, sign) in enumerate(CASES)
            ),
            spec.Line(name="exact, $L^+$"),
            spec.Line(name="exact, $L^-$", dashes=":"),
            spec.Rule("y", 0),
        ],
        spec.RELATIVE_HEIGHT,
        spec.Axis(r"change of $\langle f^+\rangle/L^\pm$ over $M(\sigma_{\delta r}/r)^2$"),
        legend="below",
        columns=2,
    )  # fmt: skip
    return spec.Figure(
        spec.Picture([panel], 3.2),
        tables={"figureB15": spec.table("phi load j shift_taylor shift_closed_form", rows)},
        facts={"height": HEIGHT, "equal_as_fractions": agree},
        words=[
            f"M = {HEIGHT}: Eq. B15 {'equals' if agree else 'does not equal'} the Taylor "
            "coefficients, as fractions"
        ],
    )
