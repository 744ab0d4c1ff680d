"""Statistics of what is linear in the radii: means, variances and covariances as closed forms.

The radii are independent, of mean zero and variance σ². A form Σ w(x) δr_x with an ordered value
has that value as its mean, and σ² Σ w(x)² as its variance. The weights are those that theorems give
quantities in the radii, put in one after the other. They are polynomials on sets of sites and
indices, so a moment is a polynomial on each of a few sets of indices: its closed form.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import sympy

from .. import sets, spheres
from .. import symbols as sy
from ..algebra.exact import FIELD, NotAStatementError, NotExactError, RationalFunction
from ..as_printed import equation
from ..forms import NUMBER, RADII, SHIFT, Form, Reader, Straightening, Value
from ..printing.text import text
from ..second_order import Jet, covariance
from ..weights import Weights
from .domain import Domain, Loading
from .rules import Rule
from .theorem import (
    Group,
    NotProvedError,
    Theorem,
    check_domain,
    difference,
    flat,
    knowing,
    made,
    meant,
    refuse,
)

_SQUARE = FIELD.generator(sy.sigma) ** 2
_PLANE = 2


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
class Statistics(Reader):
    """Reads numbers, and moments of what is linear in the radii.

    Attributes:
        domain: as a whole.
        groups: the theorems that give quantities in the radii, to be put in one after the other.
    """

    domain: Domain = Domain()
    groups: tuple[Group, ...] = ()

    @classmethod
    def on(cls, domain: Domain, groups: Iterable[Group] = ()) -> "Statistics":
        """Those on a domain."""
        return cls(domain.points, domain.straight, domain=domain, groups=tuple(groups))

    def read(self, expression: sympy.Expr) -> Value:
        """A number; moments are worked out."""
        if isinstance(expression, sy.Moment):
            value = self.moment(expression)
            return Form({NUMBER: value.merged() if self.summed else value})
        return super().read(expression)

    def moment(self, moment: sy.Moment) -> Weights:
        """A moment, as a function of the indices.

        Raises:
            NotExactError: what it is of is not linear, or not given by the radii.
        """
        if isinstance(moment, sy.Shift):
            form = self.in_radii(moment.args[0], Jet)
            return form.parts.get(SHIFT, Weights()).scaled(_SQUARE)
        forms = [self.in_radii(one, Form) for one in moment.args]
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
        linear = kind is Form
        plain, loading = Reader(self.points, self.straight, linear=linear), self.domain.loading
        if self.domain.dimension == _PLANE:
            reader = knowing(plain, self.domain, self.groups, kind)
        elif linear and loading in SPHERES.values():
            reader = replace(plain, known=spheres.known(loading.name))
        else:
            raise NotExactError("that is not known in three dimensions")
        form = reader.number(expression).on(self.points).merged()
        if {*form.parts} - {NUMBER, RADII, SHIFT}:
            raise NotExactError(f"{text(expression)} is not given by the radii")
        return form


@lru_cache(maxsize=256)
def worked_out(expression: sympy.Expr, domain: Domain, groups: tuple[Group, ...]) -> Form:
    """An expression in moments as a form, on a domain at finite size."""
    reader = Statistics.on(domain, groups)
    return reader.number(expression).on(reader.points)


Relations = tuple[sympy.Basic, ...]


@dataclass(frozen=True)
class Piece:
    """A formula of a closed form.

    Attributes:
        where: where it holds, as relations of indices; those of any of several parts.
        value: the formula.
    """

    where: tuple[Relations, ...]
    value: RationalFunction


@dataclass(frozen=True, eq=False)
class ClosedForm:
    """A number that is a function of indices: a formula on each of a few parts of its domain."""

    weights: Weights
    points: sets.Set
    straight: Straightening

    @classmethod
    def of(cls, expression: sympy.Expr, domain: Domain, *groups: Group) -> "ClosedForm":
        """An expression in moments on a domain.

        Raises:
            NotExactError: it is not linear in the radii, or not given by them.
        """
        form = worked_out(expression, domain, groups)
        if strange := {*form.parts} - {NUMBER}:
            raise NotExactError(f"{min(map(str, strange))} belongs to single beads")
        return cls(form.parts.get(NUMBER, Weights()), domain.points, domain.straight)

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Its formulas, on parts of the domain that cover it and share no point."""
        found = []
        left = self.points
        back = {symbol: FIELD.from_sympy(one) for symbol, one in self.straight.back.items()}
        for whole, value in self.weights.formulas():
            left = left - whole
            found.append(Piece(self._relations(whole), value.substitute(back)))
        if not left.is_empty():
            found.append(Piece(self._relations(left), FIELD.zero))
        return tuple(found)

    def on(self, *relations: sympy.Basic) -> RationalFunction:
        """Its formula on a part of its domain, where it is one.

        Raises:
            NotProvedError: it is not.
        """
        points = self.points & sets.where(*map(self.straight.relation, relations))
        pieces = ClosedForm(self.weights.on(points), points, self.straight).pieces
        if len(pieces) != 1:
            raise NotProvedError(f"there it is not one formula, but {len(pieces)}")
        return pieces[0].value

    @cached_property
    def weights_symbols(self) -> set[sympy.Symbol]:
        """The indices on which it depends."""
        held = set().union(*(one.free_symbols for piece in self.pieces
                             for part in piece.where for one in part))  # fmt: skip
        return held | {s for s in sy.INDICES if any(piece.value.holds(s) for piece in self.pieces)}

    def _relations(self, whole: sets.Set) -> tuple[Relations, ...]:
        return tuple(
            (
                *(sympy.Eq(self._whole(form), 0, evaluate=False) for form in equations),
                *(sympy.Ge(self._whole(form), 0, evaluate=False) for form in bounds),
            )
            for equations, bounds in sets.conditions(whole, self.points)
        )

    def _whole(self, form: sets.Row) -> sympy.Expr:
        """A form in the old indices, without fractions."""
        value = sympy.Add(*(n * s for s, n in form[0].items()), form[1])
        value = sympy.expand(value.xreplace(self.straight.back))
        return sympy.ilcm(1, *(n.q for n in value.as_coefficients_dict().values())) * value


def moment(*groups: Group) -> Rule:
    """Both sides are the same on all of the domain, moments worked out."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        check_domain(formula, domain)
        sides = meant(formula, domain)
        try:
            forms = [(worked_out(side, domain, groups),) for side in sides]
        except NotAStatementError:
            raise
        except NotExactError as reason:
            raise NotProvedError(str(reason)) from None
        apart = difference((forms[0], forms[1]), domain)
        if not all(form.is_zero() for form in apart):
            raise refuse(apart, domain, groups)
        return made(formula, domain, "moment", flat(groups))

    return rule


def theorems(quantity: sympy.Expr, domain: Domain, *groups: Group) -> tuple[Theorem, ...]:
    """What the closed form of a quantity says: a theorem for each part of a domain."""
    return tuple(
        made(equation(quantity, piece.value.to_sympy()), domain.also(*part), "moment", flat(groups))
        for piece in ClosedForm.of(quantity, domain, *groups).pieces
        for part in piece.where
    )
