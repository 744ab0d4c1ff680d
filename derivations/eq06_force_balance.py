"""Eq. 6: force balance of the loaded bead, from the constraints that its contacts impose."""

# fmt: off
import sympy
from force_diffusion.derivations.framework.vocabulary import (
    Derivation, Domain, Steps, Symbol, axioms, differentiate, equation, follows, instance, rewrite,
    terms, times)
from force_diffusion.symbolic.symbols import (
    DeltaNMinus, DeltaNPlus, ForceMinus, ForcePlus, LoadForce, e_y, epsilon, f_load, k, l,
    n_minus, n_plus, n_y, phi, site_r, site_s)
# fmt: on

LOADED = Domain.of(l >= 1, loading=axioms.LOADED)
LEFT, RIGHT = (k - 1, l - 1), (k + 1, l - 1)

PRINTED = equation(
    terms(
        LoadForce(k, l),
        times(terms(n_plus, DeltaNPlus(*LEFT)), ForcePlus(*LEFT)),
        times(terms(n_minus, DeltaNMinus(*RIGHT)), ForceMinus(*RIGHT)),
    ),
    sympy.Integer(0),
)

# a support at (X, Y) pushes on the bead at (x, y) along the gradient of their distance
x, y, X, Y = sympy.symbols("x y X Y", real=True)
SQUARED_DISTANCE = (x - X) ** 2 + (y - Y) ** 2

nu_plus = Symbol("nu_plus", r"\nu^{+}", "ν⁺")  # n⁻·δn⁺ of the supporting contact along n⁺
nu_minus = Symbol("nu_minus", r"\nu^{-}", "ν⁻")  # n⁺·δn⁻ of the supporting contact along n⁻


def to_first_order(carried: sympy.Matrix) -> sympy.Matrix:
    """The forces along n⁺ and n⁻ that carry a vector, to first order in the tilts ν of contacts.

    Args:
        carried: n⁺ and n⁻ times the vector; the strength of the disorder is ε.
    """
    system = sympy.Matrix([[1, phi + epsilon * nu_minus], [phi + epsilon * nu_plus, 1]])
    forces = system.LUsolve(carried)  # its pivots are 1 and, at ε = 0, 1 − φ²
    at_zero, slope = forces.subs(epsilon, 0), forces.diff(epsilon).subs(epsilon, 0)
    return (at_zero + slope).applyfunc(
        lambda force: sympy.expand(sympy.cancel(force * (1 - phi**2))) / (1 - phi**2)
    )


def show_steps(steps: Steps) -> None:
    """A frictionless contact pushes along the gradient of the distance of the two centres."""
    slopes = [sympy.Derivative(SQUARED_DISTANCE, axis) for axis in (x, y)]
    steps.show(
        "A frictionless contact opposes only a change of the distance between its two centres, "
        "(X, Y) of the support and (x, y) of the bead. So its force on the bead is f times the "
        "gradient of that distance, f > 0 in compression. The gradient of the squared distance, "
        "which is this times twice the distance, points from the support to the bead:",
        sympy.Tuple(equation(slopes[0], 2 * (x - X)), equation(slopes[1], 2 * (y - Y))),
        differentiate,
        Domain(),
    )
    steps.show(
        "Its length is twice the distance, so the gradient of the distance is the unit vector from "
        "one centre to the other: n⁺ + δn⁺ from (k−1, l−1), and n⁻ + δn⁻ from (k+1, l−1).",
        equation(terms(*(slope**2 for slope in slopes)), 4 * SQUARED_DISTANCE),
        differentiate,
        Domain(),
    )
    steps.show(
        "The load and the two forces add up to zero.",
        PRINTED,
        follows(
            instance(axioms.balance(), {site_r: k, site_s: l}, LOADED), *axioms.loads(axioms.LOADED)
        ),
    )
    steps.show(
        "In the ordered packing, under a load f_load straight down, each contact carries "
        "f_load/2n_y:",
        equation(f_load / (2 * n_y) * terms(n_plus, n_minus), f_load * e_y),
        rewrite(),
    )


DERIVATION = Derivation(
    number=6,
    name="force_balance",
    title="Force balance of the loaded bead",
    symbols=(
        (LoadForce(k, l), "load on bead (k, l)"),
        (ForcePlus(k - 1, l - 1), "force of the contact from (k−1, l−1), compressive when > 0"),
        (ForceMinus(k + 1, l - 1), "force of the contact from (k+1, l−1)"),
    ),
    assumptions=("no friction; contacts push along the line of centres", *LOADED.in_words()),
    printed=(PRINTED,),
    domain=LOADED,
    show_steps=show_steps,
)

if __name__ == "__main__":
    from force_diffusion.derivations.commands.cli import run_alone

    raise SystemExit(run_alone(6))
