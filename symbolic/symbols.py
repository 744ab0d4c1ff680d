"""Every symbol of the paper, once: equal names with other assumptions would be other symbols.

Python names follow the paper. Two letters serve twice there, as a radius and a spacing and as
the indices of a bead (r, s); here the bead's are ``site_r`` and ``site_s``.
"""

from typing import Any

from sympy import Piecewise

from .notation import Symbol, Written, WrittenAtSite

# geometry: radius, horizontal spacing (a length), base vectors' components and mutual cosine
r = Symbol("r", positive=True)
spacing = Symbol("s", code="spacing", positive=True)
n_x = Symbol("n_x", positive=True)
n_y = Symbol("n_y", positive=True)
phi = Symbol("phi", r"\phi", "φ", real=True)
# standard deviation of the radii (a length)
sigma = Symbol("sigma", r"\sigma_{\delta r}", "σ_δr", positive=True)
epsilon = Symbol("epsilon", r"\varepsilon", "ε", real=True)  # strength, for linearising
f_load = Symbol(
    "f_load", r"f^{\mathrm{load}}", positive=True
)  # magnitude of the load on a surface bead
m_g = Symbol("m_g", "mg", "mg", positive=True)  # weight of a bead under a bulk load
z = Symbol("z", real=True)  # relative height j/M
# a load in any direction, −(L⁺n⁺ + L⁻n⁻) on a bead (forces), and t = L⁻/L⁺
L_plus = Symbol("L_plus", "L^{+}", "L⁺", positive=True)
L_minus = Symbol("L_minus", "L^{-}", "L⁻", positive=True)
t = Symbol("t", positive=True)
# in three dimensions −Σ_a L^a n^a, t_2 = L^2/L^1 and t_3 = L^3/L^1
t_2 = Symbol("t_2", "t_{2}", "t₂", positive=True)
t_3 = Symbol("t_3", "t_{3}", "t₃", positive=True)

# indices: beads (i, j), (k, l), (r, s); height M; summation and path indices
i, j, k, l, m, n, p, q = (Symbol(name, integer=True) for name in "ijklmnpq")  # noqa: E741
site_r, site_s = (Symbol(name, code=f"site_{name}", integer=True) for name in "rs")
M = Symbol("M", integer=True, positive=True)

N = Symbol("N", integer=True, positive=True)  # neighbouring contacts or beads of one layer

H_M = Symbol("H_M", "H_{M}", "H_M", positive=True)  # Σ 1/k over 1 ≤ k ≤ M

INDICES = (i, j, k, l, m, n, p, q, site_r, site_s, M, N)
"""All index symbols, in the fixed order that normal forms use."""

PARAMETERS = (
    phi, n_x, n_y, r, spacing, sigma, epsilon, f_load, m_g, z,
    L_plus, L_minus, t, t_2, t_3,
)  # fmt: skip
"""All continuous symbols, in the fixed order that exact domains use."""

SCALES = (r, spacing, f_load)
"""What other quantities are measured in; written in front of other parameters."""

# base vectors and reciprocal vectors: linear symbols, read by ``symbolic.algebra.bases``
n_plus = Symbol("n_plus", r"\hat{\mathbf{n}}^{+}", "n⁺")
n_minus = Symbol("n_minus", r"\hat{\mathbf{n}}^{-}", "n⁻")
b_plus = Symbol("b_plus", r"\mathbf{b}^{+}", "b⁺")
b_minus = Symbol("b_minus", r"\mathbf{b}^{-}", "b⁻")
e_y = Symbol("e_y", r"\hat{\mathbf{e}}_{y}")  # the upward vertical unit vector
e_x = n_x * (b_plus - b_minus)  # the horizontal unit vector, to the right

VECTORS = (n_plus, n_minus, b_plus, b_minus, e_y)


class SiteFunction(WrittenAtSite):
    """A quantity that belongs to the bead (i, j), or to the contact above it."""

    nargs = 2
    is_vector = False


class DeltaR(SiteFunction):
    """δr_ij: deviation of the radius of bead (i, j) from r (a length)."""

    latex_head, text_head, in_code = r"\delta r", "δr", "dr"


class Position(SiteFunction):
    """x_ij: centre of bead (i, j) in the ordered packing (vector)."""

    latex_head, text_head, in_code = r"\mathbf{x}", "x", "x"
    is_vector = True


class DeltaX(SiteFunction):
    """δx_ij: displacement of bead (i, j) to first order (vector)."""

    latex_head, text_head, in_code = r"\delta\mathbf{x}", "δx", "dx"
    is_vector = True


class DeltaNPlus(SiteFunction):
    """δn⁺_ij: change of the direction from bead (i, j) to bead (i+1, j+1) (vector)."""

    latex_head, text_head, in_code = r"\delta\hat{\mathbf{n}}", "δn", "dn_plus"
    branch, is_vector = "+", True


class DeltaNMinus(SiteFunction):
    """δn⁻_ij: change of the direction from bead (i, j) to bead (i−1, j+1) (vector)."""

    latex_head, text_head, in_code = r"\delta\hat{\mathbf{n}}", "δn", "dn_minus"
    branch, is_vector = "-", True


class ForcePlus(SiteFunction):
    """f⁺_ij: force of the contact from (i, j) to (i+1, j+1), positive when compressive."""

    latex_head, text_head, in_code = "f", "f", "f_plus"
    branch = "+"


class ForceMinus(SiteFunction):
    """f⁻_ij: force of the contact from (i, j) to (i−1, j+1), positive when compressive."""

    latex_head, text_head, in_code = "f", "f", "f_minus"
    branch = "-"


class VerticalPlus(SiteFunction):
    """p⁺_ij = e_y·(n⁺ + δn⁺_ij) f⁺_ij: the vertical component of a contact's force."""

    latex_head, text_head, in_code = "p", "p", "p_plus"
    branch = "+"


class VerticalMinus(SiteFunction):
    """p⁻_ij = e_y·(n⁻ + δn⁻_ij) f⁻_ij: the vertical component of a contact's force."""

    latex_head, text_head, in_code = "p", "p", "p_minus"
    branch = "-"


class LoadForce(SiteFunction):
    """F^load on bead (k, l) (vector)."""

    latex_head, text_head, in_code = r"\mathbf{F}^{\mathrm{load}}", "Fˡᵒᵃᵈ", "load"
    is_vector = True


class SecondDifference(SiteFunction):
    """Δ_rs = 2δr_rs − δr_(r−2,s) − δr_(r+2,s), kept whole until ``doit``."""

    latex_head, text_head, in_code = r"\Delta", "Δ", "second_difference"

    def doit(self, **hints: Any) -> Any:
        """Unfold into the three radii."""
        at, layer = self.args
        return 2 * DeltaR(at, layer) - DeltaR(at - 2, layer) - DeltaR(at + 2, layer)


class Dot(Written):
    """u·v for vector expressions, kept whole; ``symbolic.algebra.bases`` expands it."""

    nargs = 2
    in_code = "dot"
    latex_form, text_form, factors = r"%(0)s \cdot %(1)s", "%(0)s·%(1)s", (0, 1)


class Moment(Written):
    """A moment over packings with independent radii, to leading order in their deviations."""


class Mean(Moment):
    """⟨X⟩, kept whole."""

    nargs = 1
    latex_form, text_form = r"\left\langle %(0)s \right\rangle", "⟨%(0)s⟩"


class Variance(Moment):
    """var X, kept whole: σ² times the sum of the squared weights of the radii."""

    nargs = 1
    latex_form, text_form = r"\mathrm{var}\left( %(0)s \right)", "var(%(0)s)"


class Covariance(Moment):
    """cov(X, Y), kept whole."""

    nargs = 2
    latex_form = r"\mathrm{cov}\left( %(0)s, %(1)s \right)"
    text_form = "cov(%(0)s, %(1)s)"


class MeanOver(Written):
    """The average over N neighbours: MeanOver(X, N, i) is that of X at i, i + 2, …, i + 2(N − 1).

    With several indices all of them go on together.
    """

    nargs = tuple(range(3, 12))
    latex_form = r"\overline{%(0)s}^{\,%(1)s}"
    text_form = "mean of %(1)s neighbours (%(0)s)"


class UnitHeight(Written):
    """The height M at which the leading order of X(M) is 1, as M → ∞; X keeps its symbol M."""

    nargs = 1
    latex_form = text_form = "M(%(0)s ∼ 1)"


class Tensile(Written):
    """P(X < 0): the probability that a force over its mean is tensile."""

    nargs = 1
    latex_form = text_form = "P(%(0)s < 0)"


class Shift(Moment):
    """⟨X⟩ less its value in the ordered packing, at second order in the deviations of the radii.

    Forces, displacements and vertical components f (n_y + e_y·δn) of forces in X stand for what
    they are to second order.
    """

    nargs = 1
    latex_form, text_form = r"\left\langle %(0)s \right\rangle_2", "⟨%(0)s⟩₂"


class LargestShare(Written):
    """The largest share that one radius has in the variance of X: max w²/Σw² of its weights."""

    nargs = 1
    latex_form = r"\max w^2/\sum w^2 \left( %(0)s \right)"
    text_form = "max w²/Σw²(%(0)s)"


class ForceAlong(Written):
    """f^a of bead (x, y, z): the force of the contact that leads up from it along base vector a.

    In three dimensions; x, y and z are steps along the three base vectors, x + y + z is the layer.
    """

    nargs = 4
    latex_form, text_form = r"f^{(%(0)s)}_{%(1)s,%(2)s,%(3)s}", "f%(0)s_(%(1)s,%(2)s,%(3)s)"


class VerticalAlong(ForceAlong):
    """The vertical component of the same."""

    latex_form, text_form = r"p^{(%(0)s)}_{%(1)s,%(2)s,%(3)s}", "p%(0)s_(%(1)s,%(2)s,%(3)s)"


class MatrixTimes(Written):
    """((a, b), (c, d)) v in Cartesian components, kept whole: arguments a, b, c, d, v."""

    nargs = 5
    in_code = "matrix_times"
    latex_form = r"\begin{pmatrix} %(0)s & %(1)s \\[2pt] %(2)s & %(3)s \end{pmatrix} %(4)s"
    text_form, factors = "((%(0)s, %(1)s), (%(2)s, %(3)s)) %(4)s", (4,)


class Braces(Written):
    """Braces with two cases: Braces(a, b, m, e) is a for m ≤ e and b for m > e.

    SymPy's Piecewise rewrites its conditions when an expression is rebuilt; this keeps them.
    """

    nargs = 4
    latex_form = (
        r"\left\{ \begin{aligned} %(0)s &: %(2)s \leq %(3)s \\ "
        r"%(1)s &: %(2)s > %(3)s \end{aligned} \right\}"
    )
    text_form = "{%(0)s if %(2)s ≤ %(3)s; %(1)s if %(2)s > %(3)s}"

    def doit(self, **hints: Any) -> Any:
        """Return the same as a Piecewise."""
        first, second, index, last = self.args
        return Piecewise((first, index <= last), (second, True))

    def _python(self, printer: Any) -> str:
        return self._filled("(%(0)s if %(2)s <= %(3)s else %(1)s)", printer)
