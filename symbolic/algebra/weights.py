"""The weights of a linear form as disjoint pieces, and the sum of their squares.

A normal form gives a site's weight as a sum over the rays that pass through it. Here the rays
of one line become runs of layers with one polynomial each, and the sites that need care (single
sites, and crossings of two lines) are listed with their full weight. Every order relation used
is decided in the region; where one is not, the region is too wide and :class:`UndeterminedError`
says which relation.
"""

from dataclasses import dataclass
from functools import cmp_to_key
from itertools import pairwise
from typing import Protocol

import sympy

from . import affine
from .affine import Affine
from .exact import (
    FIELD,
    LAYER,
    NotExactError,
    RationalFunction,
    sum_polynomial,
)
from .linear_forms import CONSTANT, LinearForm, Ray, Site


class Order(Protocol):
    """A domain of indices, in which layers and lines are compared."""

    def nonnegative(self, value: Affine) -> bool:
        """Whether value ≥ 0 everywhere."""

    def below(self, left: Affine, right: Affine) -> bool:
        """Whether left < right everywhere."""

    def differ(self, left: Affine, right: Affine) -> bool:
        """Whether left ≠ right everywhere."""


class UndeterminedError(NotExactError):
    """An order relation between layers does not hold throughout the region.

    Args:
        reason: which, in words.
        apart: whose sign is not known; None for what no sign decides.
    """

    def __init__(self, reason: str, apart: Affine | None = None):
        super().__init__(reason)
        self.reason, self.apart = reason, apart

    @property
    def number(self) -> sympy.Expr | None:
        """The same in SymPy."""
        return None if self.apart is None else affine.to_sympy(self.apart)


@dataclass(frozen=True)
class Run:
    """Layers first … last of one line, all with the weight polynomial ``weight`` in the layer."""

    ray: Ray
    first: Affine
    last: Affine
    weight: RationalFunction

    def at(self, layer: Affine) -> RationalFunction:
        """The weight of one of the layers."""
        return self.weight.substitute({LAYER: affine.to_field(layer)})


@dataclass(frozen=True)
class Pieces:
    """A form taken apart: runs, and sites that lie on no run, on several, or carry extra weight.

    ``special`` maps a site to its full weight and to the runs' own weights there, which the
    sums over the runs have counted already.
    """

    runs: tuple[Run, ...]
    special: dict[Site, tuple[RationalFunction, tuple[RationalFunction, ...]]]

    def sum_of_squares(self) -> RationalFunction:
        """Σ weight²: the variance of the form, in units of the variance of one radius."""
        total = FIELD.zero
        for run in self.runs:
            square = run.weight * run.weight
            first, last = affine.to_field(run.first), affine.to_field(run.last)
            total = total + sum_polynomial(square, LAYER, first, last)
        for full, counted in self.special.values():
            total = total + full * full
            for part in counted:
                total = total - part * part
        return total


def take_apart(form: LinearForm, region: Order) -> Pieces:
    """Disjoint pieces of a form.

    Raises:
        UndeterminedError: when the region does not fix the order of the breakpoints.
        NotExactError: when the form has a constant term or an endless ray.
    """
    if any(site.family == CONSTANT for site in form.sites):
        raise NotExactError("a constant has no variance: subtract it first")
    runs = tuple(run for line in _lines(form) for run in _runs(line, form, region))
    sites = dict.fromkeys(form.sites)
    for a, one in enumerate(runs):
        for other in runs[:a]:
            crossing = _crossing(one.ray, other.ray)
            if crossing and not any(_outside(crossing, run, region) for run in (one, other)):
                sites[crossing] = None
    _assert_distinct(list(sites), region)
    _assert_lines_apart(runs, region)
    special = {}
    for site in sites:
        counted = tuple(run.at(site.j) for run in runs if _meets(site, run, region))
        full = form.sites.get(site, FIELD.zero)
        for part in counted:
            full = full + part
        special[site] = full, counted
    return Pieces(runs, special)


def sum_of_products(one: LinearForm, other: LinearForm, region: Order) -> RationalFunction:
    """Σ weight · weight′ over all sites of two forms: their covariance, in the same unit.

    Single sites and runs of one form meet those of the other in one site, on a line, or nowhere.

    Raises:
        UndeterminedError: when the region does not fix which.
        NotExactError: when a form has a constant term or an endless ray.
    """
    forms = (one,) if one is other else (one, other)
    if any(site.family == CONSTANT for form in forms for site in form.sites):
        raise NotExactError("a constant has no variance: subtract it first")
    runs = [[run for line in _lines(form) for run in _runs(line, form, region)] for form in forms]
    total = FIELD.zero
    for a, (site, weight) in enumerate(one.sites.items()):
        for b, (place, factor) in enumerate(other.sites.items()):
            if one is other and b > a:
                break
            if _are_one(site, place, region):
                total = total + weight * factor
    for form, against in ((one, runs[-1]), (other, runs[0])):
        for site, weight in form.sites.items():
            for run in against:
                if _meets(site, run, region):
                    total = total + weight * run.at(site.j)
    for run in runs[0]:
        for line in runs[-1]:
            total = total + _shared(run, line, region)
    return total


def _are_one(one: Site, other: Site, region: Order) -> bool:
    if one == other:
        return True
    if one.family != other.family or region.differ(one.i, other.i) or region.differ(one.j, other.j):
        return False
    raise UndeterminedError(
        f"sites ({affine.to_sympy(one.i)}, {affine.to_sympy(one.j)}) and "
        f"({affine.to_sympy(other.i)}, {affine.to_sympy(other.j)})",
        affine.add(*((one.i, other.i) if one.i != other.i else (one.j, other.j)), -1),
    )


def _shared(one: Run, other: Run, region: Order) -> RationalFunction:
    """Σ of the products of two runs' weights."""
    if region.below(one.last, other.first) or region.below(other.last, one.first):
        return FIELD.zero
    crossing = _crossing(one.ray, other.ray)
    if crossing is not None:
        if not all(_inside(crossing, run, region) for run in (one, other)):
            return FIELD.zero
        return one.at(crossing.j) * other.at(crossing.j)
    if (one.ray.family, one.ray.slope) != (other.ray.family, other.ray.slope):
        return FIELD.zero
    if one.ray.line != other.ray.line:
        _assert_lines_apart((one, other), region)
        return FIELD.zero
    first = one.first if _is_last(one.first, other.first, region) else other.first
    last = other.last if _is_last(one.last, other.last, region) else one.last
    if not _is_last(affine.shifted(last, 1), first, region):
        return FIELD.zero
    return sum_polynomial(
        one.weight * other.weight, LAYER, affine.to_field(first), affine.to_field(last)
    )


def _is_last(layer: Affine, other: Affine, region: Order) -> bool:
    """Whether a layer is the other one or above it."""
    apart = affine.add(layer, other, -1)
    if region.nonnegative(apart):
        return True
    if region.nonnegative(affine.times(apart, -1)):
        return False
    raise UndeterminedError(f"layers {affine.to_sympy(layer)} and {affine.to_sympy(other)}", apart)


def _lines(form: LinearForm) -> list[tuple[str, int, Affine]]:
    return list(dict.fromkeys((ray.family, ray.slope, ray.line) for ray in form.rays))


def _runs(line: tuple[str, int, Affine], form: LinearForm, region: Order) -> list[Run]:
    rays = [ray for ray in form.rays if (ray.family, ray.slope, ray.line) == line]

    def order(one: Ray, other: Ray) -> int:
        if region.nonnegative(affine.add(other.start, one.start, -1)):
            return -1
        if region.nonnegative(affine.add(one.start, other.start, -1)):
            return 1
        raise UndeterminedError(
            f"layers {affine.to_sympy(one.start)} and {affine.to_sympy(other.start)}",
            affine.add(one.start, other.start, -1),
        )

    rays.sort(key=cmp_to_key(order))
    runs, weight = [], FIELD.zero
    for ray, following in pairwise(rays):
        weight = weight + form.rays[ray]
        if not weight.is_zero():
            runs.append(Run(ray, ray.start, affine.shifted(following.start, -1), weight))
    if not (weight + form.rays[rays[-1]]).is_zero():
        raise NotExactError("a line of the form has no end")
    return runs


def _crossing(one: Ray, other: Ray) -> Site | None:
    if one.family != other.family or one.slope == other.slope:
        return None
    plus, minus = (one, other) if one.slope == 1 else (other, one)
    twice = affine.add(minus.line, plus.line, -1)  # twice the layer of the crossing
    if twice[-1] % 2 and all(c % 2 == 0 for c in twice[:-1]):
        return None  # the lines pass through each other between the sites
    if any(c % 2 for c in twice):
        raise UndeterminedError(f"whether {affine.to_sympy(twice)} is even")
    return plus.site(tuple(c // 2 for c in twice))


def _meets(site: Site, run: Run, region: Order) -> bool:
    """Decide whether a run passes through a site: always in the region, or never."""
    if site.family != run.ray.family or _outside(site, run, region):
        return False
    on_line = run.ray.site(site.j)
    if site == on_line:
        return _inside(site, run, region)
    if region.differ(site.i, on_line.i):
        return False
    raise UndeterminedError(
        f"whether ({affine.to_sympy(site.i)}, {affine.to_sympy(site.j)}) lies on the line "
        f"({affine.to_sympy(on_line.i)}, {affine.to_sympy(site.j)})",
        affine.add(site.i, on_line.i, -1),
    )


def _assert_lines_apart(runs: tuple[Run, ...], region: Order) -> None:
    """Two runs of parallel lines must lie on different lines, or in different layers."""
    for a, one in enumerate(runs):
        for other in runs[:a]:
            parallel = (one.ray.family, one.ray.slope) == (other.ray.family, other.ray.slope)
            if not parallel or one.ray.line == other.ray.line:
                continue
            apart = (
                region.differ(one.ray.line, other.ray.line)
                or region.below(one.last, other.first)
                or region.below(other.last, one.first)
            )
            if not apart:
                raise UndeterminedError(
                    f"whether the lines {affine.to_sympy(one.ray.line)} and "
                    f"{affine.to_sympy(other.ray.line)} are one",
                    affine.add(one.ray.line, other.ray.line, -1),
                )


def _outside(site: Site, run: Run, region: Order) -> bool:
    return region.below(site.j, run.first) or region.below(run.last, site.j)


def _inside(site: Site, run: Run, region: Order) -> bool:
    above = affine.add(site.j, run.first, -1)
    below = affine.add(run.last, site.j, -1)
    if region.nonnegative(above) and region.nonnegative(below):
        return True
    if _outside(site, run, region):
        return False
    raise UndeterminedError(
        f"layer {affine.to_sympy(site.j)} against "
        f"{affine.to_sympy(run.first)} … {affine.to_sympy(run.last)}",
        below if region.nonnegative(above) else above,
    )


def _assert_distinct(sites: list[Site], region: Order) -> None:
    for a, one in enumerate(sites):
        for other in sites[:a]:
            _are_one(one, other, region)
