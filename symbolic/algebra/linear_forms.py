"""Linear forms in a quantity on the lattice, in a normal form that decides equality.

A form is a finite sum of weights on single sites and of *rays*: a ray gives every site of one
lattice diagonal, from a starting layer upwards, a weight that is a polynomial in the layer. A
line sum is the difference of two rays. Site and start are affine in the indices i, j, M, …;
weights are rational functions of the indices and of the parameters.

A ray that starts at layer L + c, c a whole number, is moved to L, single sites making up the
difference. For large generic indices the different L lie far apart, and a nonzero polynomial
has finitely many zeros; so two forms are equal as functions of the indices exactly when their
normal forms are (what is normal in them is unique). Sums follow Karr's convention
Σ_{n=a}^{b} + Σ_{n=b+1}^{c} = Σ_{n=a}^{c}; :mod:`symbolic.algebra.reading` asserts the bounds.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import sympy

from . import affine
from .affine import Affine
from .exact import (
    FIELD,
    LAYER,
    NotExactError,
    RationalFunction,
    antidifference,
    sum_polynomial,
)

CONSTANT = ""
"""Family of the terms that hold no lattice quantity."""

ORDERED = ("Position", "Load")
"""Families of quantities that are no deviations: their products are not of second order."""


@dataclass(frozen=True)
class Site:
    """One bead (i, j) and the quantity taken there."""

    family: str
    i: Affine
    j: Affine


@dataclass(frozen=True)
class Ray:
    """Sites (line + slope·layer, layer) for layer ≥ start; slope +1 is along n⁺, −1 along n⁻."""

    family: str
    slope: int
    line: Affine
    start: Affine

    def site(self, layer: Affine) -> Site:
        """The site of the ray's line in a layer."""
        return Site(self.family, affine.add(self.line, layer, self.slope), layer)


NO_SITE = Site(CONSTANT, affine.ZERO, affine.ZERO)
"""Where the constant term of a form is kept."""


@dataclass
class LinearForm:
    """Weights on sites and on rays; zero weights are left out."""

    sites: dict[Site, RationalFunction] = field(default_factory=dict)
    rays: dict[Ray, RationalFunction] = field(default_factory=dict)

    @classmethod
    def at(cls, family: str, i: Affine, j: Affine) -> "LinearForm":
        """The quantity at one site."""
        return cls({Site(family, i, j): FIELD.one})

    @classmethod
    def constant(cls, value: RationalFunction) -> "LinearForm":
        """A term without any lattice quantity."""
        form = cls()
        form.add_site(NO_SITE, value)
        return form

    def add_site(self, site: Site, weight: RationalFunction) -> None:
        """Add to the weight of a site."""
        if site in self.sites:
            weight = self.sites[site] + weight
        if weight.is_zero():
            self.sites.pop(site, None)
        else:
            self.sites[site] = weight

    def add_ray(self, ray: Ray, weight: RationalFunction) -> None:
        """Add a ray, moved to a start without constant."""
        offset = ray.start[-1]
        base = affine.shifted(ray.start, -offset)
        for step in range(min(offset, 0), max(offset, 0)):
            layer = affine.shifted(base, step)
            value = weight.substitute({LAYER: affine.to_field(layer)})
            self.add_site(ray.site(layer), -value if offset > 0 else value)
        ray = Ray(ray.family, ray.slope, ray.line, base)
        if ray in self.rays:
            weight = self.rays[ray] + weight
        if weight.is_zero():
            self.rays.pop(ray, None)
        else:
            self.rays[ray] = weight

    def __add__(self, other: "LinearForm") -> "LinearForm":
        result = LinearForm(dict(self.sites), dict(self.rays))
        for site, weight in other.sites.items():
            result.add_site(site, weight)
        for ray, weight in other.rays.items():
            result.add_ray(ray, weight)
        return result

    def scaled(self, factor: RationalFunction) -> "LinearForm":
        """The form times a factor."""
        if factor.is_zero():
            return LinearForm()
        return LinearForm(
            {site: weight * factor for site, weight in self.sites.items()},
            {ray: weight * factor for ray, weight in self.rays.items()},
        )

    def __neg__(self) -> "LinearForm":
        return self.scaled(FIELD.constant(-1))

    def __sub__(self, other: "LinearForm") -> "LinearForm":
        return self + (-other)

    @property
    def at_zero(self) -> RationalFunction:
        """The constant term: the form's value at order 0 in the deviations of the radii."""
        return self.sites.get(NO_SITE, FIELD.zero)

    def times(self, other: "LinearForm") -> "LinearForm":
        """The product to first order: what is of first order in both is dropped.

        Raises:
            NotExactError: a quantity of order 0 is multiplied by one of the lattice.
        """
        for one, factor in ((self, other), (other, self)):
            families = {*(site.family for site in one.sites), *(ray.family for ray in one.rays)}
            if factor.constant_part() is None and any(f.startswith(ORDERED) for f in families):
                raise NotExactError("a product of a quantity of order 0 is not read")
        both = self.scaled(other.at_zero) + other.scaled(self.at_zero)
        return both + LinearForm.constant(-(self.at_zero * other.at_zero))

    def mapped(self, change: Callable[[RationalFunction], RationalFunction]) -> "LinearForm":
        """The form with every weight changed."""
        result = LinearForm()
        for site, weight in self.sites.items():
            result.add_site(site, change(weight))
        for ray, weight in self.rays.items():
            result.add_ray(ray, change(weight))
        return result

    def put_in(self, image: Mapping[sympy.Symbol, Affine]) -> "LinearForm":
        """The form at other indices, for which it has been read as well.

        Rays stay where they start: moved to the normal form, they would leave single sites behind,
        and these more coincidences to tell apart.
        """
        result = LinearForm()
        numbers = {symbol: affine.to_field(value) for symbol, value in image.items()}
        for site, weight in self.sites.items():
            i, j = (affine.put_in(index, image) for index in (site.i, site.j))
            result.add_site(Site(site.family, i, j), weight.substitute(numbers))
        for ray, weight in self.rays.items():
            line, start = (affine.put_in(index, image) for index in (ray.line, ray.start))
            moved = Ray(ray.family, ray.slope, line, start)
            result.rays[moved] = result.rays.get(moved, FIELD.zero) + weight.substitute(numbers)
        return result

    def is_zero(self) -> bool:
        """Decide whether the form vanishes for all values of the indices."""
        return not self.sites and not self.rays

    def constant_part(self) -> RationalFunction | None:
        """The value of a form that holds no lattice quantity; None for any other."""
        if self.rays or any(site.family != CONSTANT for site in self.sites):
            return None
        return next(iter(self.sites.values()), FIELD.zero)

    def summed(self, index: sympy.Symbol, low: Affine, high: Affine) -> "LinearForm":
        """Σ over ``index`` from low to high.

        Raises:
            NotExactError: when a site or ray does not step along one lattice diagonal.
        """
        result = LinearForm()
        for site, weight in self.sites.items():
            _sum_site(result, site, weight, index, low, high)
        for ray, weight in self.rays.items():
            _sum_ray(result, ray, weight, index, low, high)
        return result


def _sum_site(
    result: LinearForm,
    site: Site,
    weight: RationalFunction,
    index: sympy.Symbol,
    low: Affine,
    high: Affine,
) -> None:
    step_i, step_j = affine.coefficient(site.i, index), affine.coefficient(site.j, index)
    if step_i == step_j == 0:
        total = sum_polynomial(weight, index, affine.to_field(low), affine.to_field(high))
        result.add_site(site, total)
        return
    if abs(step_i) != 1 or abs(step_j) != 1:
        raise NotExactError(f"a sum over {index} that leaves the lattice diagonals")
    slope = step_i * step_j
    at_zero = affine.without(site.j, index)
    line = affine.add(affine.without(site.i, index), at_zero, -slope)
    # layer = at_zero ± index, so that the index is ±(layer − at_zero)
    layer = FIELD.generator(LAYER) - affine.to_field(at_zero)
    along = weight.substitute({index: layer if step_j == 1 else -layer})
    if step_j == 1:
        first, last = affine.add(at_zero, low), affine.add(at_zero, high)
    else:
        first, last = affine.add(at_zero, high, -1), affine.add(at_zero, low, -1)
    result.add_ray(Ray(site.family, slope, line, first), along)
    result.add_ray(Ray(site.family, slope, line, affine.shifted(last, 1)), -along)


def _sum_ray(
    result: LinearForm,
    ray: Ray,
    weight: RationalFunction,
    index: sympy.Symbol,
    low: Affine,
    high: Affine,
) -> None:
    if affine.coefficient(ray.line, index):
        raise NotExactError(f"a sum over {index} that covers an area")
    step = affine.coefficient(ray.start, index)
    if abs(step) > 1:
        raise NotExactError(f"a sum over {index} that skips layers")
    at_zero = affine.without(ray.start, index)
    upper, lower = affine.to_field(high), affine.to_field(affine.shifted(low, -1))
    total = antidifference(weight, index)

    def between(first: RationalFunction, last: RationalFunction) -> RationalFunction:
        return total.substitute({index: last}) - total.substitute({index: first})

    def ray_from(start: Affine, value: RationalFunction) -> None:
        result.add_ray(Ray(ray.family, ray.slope, ray.line, start), value)

    layer = FIELD.generator(LAYER) - affine.to_field(at_zero)
    if step == 0:
        ray_from(at_zero, between(lower, upper))
    elif step == 1:
        # layer ≥ at_zero + n: the terms n = low … layer − at_zero, all of them above the last
        ray_from(affine.add(at_zero, low), between(lower, layer))
        ray_from(affine.shifted(affine.add(at_zero, high), 1), between(layer, upper))
    else:
        # layer ≥ at_zero − n: the terms n = at_zero − layer … high, all of them from the first
        ray_from(affine.add(at_zero, high, -1), between(-layer - FIELD.one, upper))
        ray_from(affine.add(at_zero, low, -1), between(lower, -layer - FIELD.one))
