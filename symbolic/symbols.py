"""Every symbol of the paper, once: equal names with other assumptions would be other symbols.

Python names follow the paper. Two letters serve twice there, as a radius and a spacing and as
the indices of a bead (r, s); here the bead's are ``site_r`` and ``site_s``.
"""

from typing import Any

from sympy import Function, Piecewise, Symbol

# geometry: radius, horizontal spacing (a length), base vectors' components and mutual cosine
r = Symbol("r", positive=True)
spacing = Symbol("s", positive=True)
n_x = Symbol("n_x", positive=True)
n_y = Symbol("n_y", positive=True)
phi = Symbol("phi", real=True)
sigma = Symbol("sigma", positive=True)  # standard deviation σ_δr of the radii (a length)
epsilon = Symbol("epsilon", real=True)  # strength of the disorder, for linearising
f_load = Symbol("f_load", positive=True)  # magnitude of the load on a surface bead
m_g = Symbol("m_g", positive=True)  # weight of a bead under a bulk load
z = Symbol("z", real=True)  # relative height j/M

# indices: beads (i, j), (k, l), (r, s); height M; summation and path indices
i, j, k, l, m, n, p, q = (Symbol(name, integer=True) for name in "ijklmnpq")  # noqa: E741
site_r, site_s = (Symbol(name, integer=True) for name in "rs")
M = Symbol("M", integer=True, positive=True)

INDICES = (i, j, k, l, m, n, p, q, site_r, site_s, M)
"""All index symbols, in the fixed order that normal forms use."""

PARAMETERS = (phi, n_x, n_y, r, spacing, sigma, epsilon, f_load, m_g, z)
"""All continuous symbols, in the fixed order that exact domains use."""

# base vectors and reciprocal vectors: linear symbols, read by ``symbolic.mechanics.vectors``
n_plus = Symbol("n_plus")
n_minus = Symbol("n_minus")
b_plus = Symbol("b_plus")
b_minus = Symbol("b_minus")
e_y = Symbol("e_y")  # the upward vertical unit vector

VECTORS = (n_plus, n_minus, b_plus, b_minus, e_y)


class SiteFunction(Function):  # type: ignore[misc]
    """A quantity that belongs to the bead (i, j), or to the contact above it."""

    nargs = 2
    latex_head = ""
    text_head = ""
    branch = ""  # "+" or "-" for a contact's quantity
    is_vector = False

    @property
    def site(self) -> tuple[Any, Any]:
        """The indices (i, j)."""
        return self.args[0], self.args[1]


class DeltaR(SiteFunction):
    """δr_ij: deviation of the radius of bead (i, j) from r (a length)."""

    latex_head, text_head = r"\delta r", "δr"


class Position(SiteFunction):
    """x_ij: centre of bead (i, j) in the ordered packing (vector)."""

    latex_head, text_head, is_vector = r"{\bf x}", "x", True


class DeltaX(SiteFunction):
    """δx_ij: displacement of bead (i, j) to first order (vector)."""

    latex_head, text_head, is_vector = r"\delta{\bf x}", "δx", True


class DeltaNPlus(SiteFunction):
    """δn⁺_ij: change of the direction from bead (i, j) to bead (i+1, j+1) (vector)."""

    latex_head, text_head, branch, is_vector = r"\delta\hat{\bf n}", "δn", "+", True


class DeltaNMinus(SiteFunction):
    """δn⁻_ij: change of the direction from bead (i, j) to bead (i−1, j+1) (vector)."""

    latex_head, text_head, branch, is_vector = r"\delta\hat{\bf n}", "δn", "-", True


class ForcePlus(SiteFunction):
    """f⁺_ij: force of the contact from (i, j) to (i+1, j+1), positive when compressive."""

    latex_head, text_head, branch = "f", "f", "+"


class ForceMinus(SiteFunction):
    """f⁻_ij: force of the contact from (i, j) to (i−1, j+1), positive when compressive."""

    latex_head, text_head, branch = "f", "f", "-"


class Load(SiteFunction):
    """F^load on bead (k, l) (vector)."""

    latex_head, text_head, is_vector = r"{\bf F}^{\rm load}", "Fˡᵒᵃᵈ", True


class SecondDifference(SiteFunction):
    """Δ_rs = 2δr_rs − δr_(r−2,s) − δr_(r+2,s), kept whole until ``doit``."""

    latex_head, text_head = r"\Delta", "Δ"

    def doit(self, **hints: Any) -> Any:
        """Unfold into the three radii."""
        at, layer = self.args
        return 2 * DeltaR(at, layer) - DeltaR(at - 2, layer) - DeltaR(at + 2, layer)


class Dot(Function):  # type: ignore[misc]
    """u·v for vector expressions, kept whole; ``symbolic.mechanics.vectors`` expands it."""

    nargs = 2


class MatrixTimes(Function):  # type: ignore[misc]
    """((a, b), (c, d)) v in Cartesian components, kept whole: arguments a, b, c, d, v."""

    nargs = 5


class Braces(Function):  # type: ignore[misc]
    """Braces with two cases: Braces(a, b, m, e) is a for m ≤ e and b for m > e.

    SymPy's Piecewise rewrites its conditions when an expression is rebuilt; this keeps them.
    """

    nargs = 4

    def doit(self, **hints: Any) -> Any:
        """Return the same as a Piecewise."""
        first, second, index, last = self.args
        return Piecewise((first, index <= last), (second, True))
