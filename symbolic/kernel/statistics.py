"""Statistics of what is linear in the radii: means, variances and covariances as closed forms.

The radii are independent, of mean zero and variance σ². A form Σ w(x) δr_x with an ordered value
has that value as its mean, and σ² Σ w(x)² as its variance. The weights are those that theorems give
quantities in the radii, put in one after the other. They are polynomials on sets of sites and
indices, so a moment is a polynomial on each of a few sets of indices: its closed form.
"""

from dataclasses import dataclass, field, replace
from functools import lru_cache

import sympy

from .. import spheres
from .. import symbols as sy
from ..algebra.exact import FIELD, NotExactError, NotProvedError
from ..forms import NUMBER, RADII, SHIFT, Form, Reader, Value
from ..printing.text import text
from ..second_order import Jet, covariance
from ..weights import Weights
from .domain import Domain, Loading
from .refuted import refuse
from .rules import Rule
from .theorem import (
    Group,
    Groups,
    Theorem,
    check_domain,
    difference,
    flat,
    in_kernel_symbols,
    knowing,
    made,
    written_out,
)

_SQUARE = FIELD.generator(sy.sigma) ** 2


_SPHERES = "each bead rests on three others, and "
_DIRECTION = "a load along the sum of the base vectors"
_LEANS = "a load −Σ_a L^a n^a, L^2 = t_2 L^1, L^3 = t_3 L^1"
SPHERES = {
    name: Loading(name, _SPHERES + words, place)
    for name, words, place in (
        ("surface", f"each bead of the surface carries {_DIRECTION}", (sy.M,)),
        ("bulk", f"each bead above the base carries {_DIRECTION}", (sy.M,)),
        ("surface leaning", f"each bead of the surface carries {_LEANS}", (sy.M,)),
        ("bulk leaning", f"each bead above the base carries {_LEANS}", (sy.M,)),
        ("point", f"bead (0, 0, l) alone carries {_DIRECTION}", (sy.l,)),
    )
}
"""The loads on packings of spheres. What forces are in the radii is part of what is trusted."""


# moments


@dataclass(frozen=True, eq=False)
class MomentReader(Reader):
    """Reads numbers, and moments of what is linear in the radii.

    Attributes:
        domain: as a whole.
        groups: the theorems that give quantities in the radii, to be put in one after the other.
        moments: theorems that say what moments are; others are worked out.
    """

    domain: Domain = field(default_factory=Domain)
    groups: Groups = ()
    moments: Groups = ()

    @classmethod
    def on(cls, domain: Domain, groups: Groups = ()) -> "MomentReader":
        """Those on a domain, by theorems about quantities and about moments.

        Raises:
            NotProvedError: a theorem about a moment is one of other packings.
        """
        moments = tuple(filter(_is_of_a_moment, groups))
        for own in (theorem.domain for theorem in flat(moments)):
            images = ((each.straight.image.get(s) for each in (domain, own)) for s in own.indices)
            alike = all(first == second for first, second in images)
            if own.limit or not (domain.shares_packings_of(own) and alike):
                raise NotProvedError("a moment is known of other packings, or of other beads")
        # the place of the load is not fixed: what the radii determine is known for every place
        fixed = frozenset[sympy.Symbol]().union(*(theorem.fixed for theorem in flat(groups)))
        others = tuple(group for group in groups if group not in moments)
        points, straight = domain.points, domain.straight
        return cls(points, straight, fixed=fixed, domain=domain, groups=others, moments=moments)

    def read(self, expression: sympy.Expr) -> Value:
        """A number; moments are put in, or worked out."""
        if isinstance(expression, sy.Moment):
            return self._moment(expression)
        return super().read(expression)

    def _moment(self, moment: sy.Moment) -> Form:
        """What theorems say that a moment is, and elsewhere what it comes to."""
        total, left = self.kind(), self.points
        for theorem in flat(self.moments):
            about, value = (written_out(side, theorem.domain) for side in theorem.formula.args)
            inside = left & theorem.domain.points
            if about == moment and not inside.is_empty():
                total = total + replace(self, points=inside).number(value).on(inside)
                left = left - inside
        if self.points.is_empty() or not left.is_empty():
            total = total + Form({NUMBER: replace(self, points=left)._worked_out(moment).on(left)})
        return total.merged() if self.summed else total

    def _worked_out(self, moment: sy.Moment) -> Weights:
        """A moment worked out, as a function of the indices.

        Raises:
            NotExactError: an observable is not linear in the radii, or not determined by them.
        """
        if isinstance(moment, sy.Shift):
            form = self.in_radii(moment.args[0], Jet)
            return form.parts.get(SHIFT, Weights()).scaled(_SQUARE)
        forms = [self.in_radii(arg, Form) for arg in moment.args]
        if isinstance(moment, sy.Mean):
            return forms[0].parts.get(NUMBER, Weights())
        if isinstance(moment, sy.Variance | sy.Covariance):
            return covariance(forms[0], forms[-1], self.domain.dimension).scaled(_SQUARE)
        raise NotExactError(f"{text(moment)} is not worked out")

    def in_radii(self, expression: sympy.Expr, kind: type[Form] = Form) -> Form:
        """A number as an ordered value and weights of the radii.

        Raises:
            NotExactError: it is not linear in them, or holds what is not given by them.
        """
        linear, loading = kind is Form, self.domain.loading
        plain = Reader(self.points, self.straight, linear=linear, summed=self.summed)
        if self.domain.dimension == 2:
            reader = knowing(plain, self.domain, self.groups, kind)
        elif linear and loading and loading in SPHERES.values():
            reader = replace(plain, known=spheres.forces_in_radii(loading.name))
        else:
            raise NotExactError("that is not known in three dimensions")
        form = reader.number(expression).on(self.points).merged()
        if {*form.parts} - {NUMBER, RADII, SHIFT}:
            raise NotExactError(f"{text(expression)} is not determined by the radii")
        return form


def _is_of_a_moment(group: Group) -> bool:
    """Whether it is a theorem that says what a moment is, and not by other moments."""
    if isinstance(group, tuple):
        return False
    left, right = group.formula.args
    return isinstance(left, sy.Moment) and not right.has(sy.Moment)


@lru_cache(maxsize=256)
def worked_out(expression: sympy.Expr, domain: Domain, groups: Groups) -> Form:
    """An expression in moments as a form, on a domain at finite size."""
    reader = MomentReader.on(domain, groups)
    return reader.number(expression).on(reader.points).merged()


def moment(*groups: Group, on: Domain | None = None) -> Rule:
    """Both sides are the same on all of the domain, moments worked out.

    Args:
        groups: the theorems that give quantities in the radii.
        on: a larger domain, on which moments are worked out once for several parts of it.
    """

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        check_domain(formula, domain)
        whole = domain if on is None else on
        about = [(each.loading, each.beads, each.dimension, each.limit) for each in (whole, domain)]
        if about[0] != about[1]:
            raise NotProvedError("the larger domain is another one")
        if not domain.points.is_subset(whole.points):
            raise NotProvedError("the domain is no part of the larger one")
        left, right = in_kernel_symbols(formula, domain)
        forms = worked_out(left, whole, groups), worked_out(right, domain, groups)
        apart = difference(((forms[0],), (forms[1],)), domain)
        if any(form.parts for form in apart):
            raise refuse(apart, domain, groups, formula)
        return made(formula, domain, "taking moments of the radii", flat(groups))

    return rule
