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

from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Affine
from force_diffusion.symbolic.algebra.exact import (
    FIELD,
    LAYER,
    NotExactError,
    RationalFunction,
    sum_polynomial,
)
from force_diffusion.symbolic.algebra.linear_forms import CONSTANT, LinearForm, Ray, Site


class Order(Protocol):
    """A domain of indices, in which layers and lines are compared."""

    def nonnegative(self, value: Affine) -> bool:
        """Whether value ≥ 0 everywhere."""

    def below(self, left: Affine, right: Affine) -> bool:
        """Whether left < right everywhere."""

    def differ(self, left: Affine, right: Affine) -> bool:
        """Whether left ≠ right everywhere."""


class UndeterminedError(NotExactError):
    """An order relation between layers does not hold throughout the region."""


@dataclass(frozen=True)
class Run:
    """Layers first … last of one line, all with the weight polynomial ``weight`` in the layer."""

    ray: Ray
    first: Affine
    last: Affine
    weight: RationalFunction


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
        counted = tuple(
            run.weight.substitute({LAYER: affine.to_field(site.j)})
            for run in runs
            if _meets(site, run, region)
        )
        full = form.sites.get(site, FIELD.zero)
        for part in counted:
            full = full + part
        special[site] = full, counted
    return Pieces(runs, special)


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
            f"layers {affine.to_sympy(one.start)} and {affine.to_sympy(other.start)}"
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
        f"({affine.to_sympy(on_line.i)}, {affine.to_sympy(site.j)})"
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
                    f"{affine.to_sympy(other.ray.line)} are one"
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
        f"{affine.to_sympy(run.first)} … {affine.to_sympy(run.last)}"
    )


def _assert_distinct(sites: list[Site], region: Order) -> None:
    for a, one in enumerate(sites):
        for other in sites[:a]:
            if one.family == other.family and not (
                region.differ(one.i, other.i) or region.differ(one.j, other.j)
            ):
                raise UndeterminedError(
                    f"sites ({affine.to_sympy(one.i)}, {affine.to_sympy(one.j)}) and "
                    f"({affine.to_sympy(other.i)}, {affine.to_sympy(other.j)})"
                )
