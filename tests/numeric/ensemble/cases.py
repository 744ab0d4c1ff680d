"""Small ensembles for the tests."""

from functools import reduce
from operator import add
from typing import Any

from force_diffusion.numeric.ensemble.result import Ensemble
from force_diffusion.numeric.ensemble.sums import Measurement, Sums, measurement, solve_block

from tests.numeric.scenes import scene

PROFILE: dict[str, dict[str, Any]] = {
    "packing": {"height": 4, "width": 6},
    "disorder": {"kind": "uniform", "relative_std": "=1e-4", "seed": 5},
    "ask": {"quantity": "profile"},
}
POINT: dict[str, Any] = {"kind": "point", "at": [0, 4]}


def asking(quantity: str, **ask: Any) -> dict[str, dict[str, Any]]:
    return PROFILE | {"ask": {"quantity": quantity, **ask}}


SPHERES: dict[str, dict[str, Any]] = {"packing": {"height": 3, "width": 5, "dimension": 3}}
SLAB: dict[str, dict[str, Any]] = {"packing": {"height": 5}}
FIRST: dict[str, dict[str, Any]] = {"effects": {"geometry": "first-order"}}
CASES: dict[str, dict[str, dict[str, Any]]] = {
    "profile": PROFILE,
    "profile of a bulk load": PROFILE | {"load": {"kind": "bulk"}},
    "profile, first order": PROFILE | FIRST,
    "profile below a point load": PROFILE | {"load": {"kind": "point", "at": [3, 3]}},
    "contact of a slab": asking("contact", at=[0, 2, "-"]) | SLAB,
    "contact by line sums": asking("contact", at=[0, 2, "+"]) | FIRST,
    "all contacts": asking("contact_forces"),
    "response": asking("response") | {"packing": {"height": 4}, "load": POINT},
    "two layers of a response": asking("response", layers=[3, 1]) | {"load": POINT},
    "histogram of all": asking("histogram", bins=11),
    "profile of spheres": PROFILE | SPHERES,
    "bulk profile of spheres": PROFILE | SPHERES | {"load": {"kind": "bulk"}},
    "all contacts of spheres": asking("contact_forces") | SPHERES,
    "one contact of spheres": asking("contact", at=[0, 2, 1, "2"]) | SPHERES,
    "response of spheres": asking("response")
    | SPHERES
    | {"load": {"kind": "point", "at": [1, 1, 2]}},
    "histogram of spheres": asking("histogram", bins=11) | SPHERES,
    "histogram of one": asking("histogram", at=[0, 2, "+"]),
}


def case(name: str, **disorder: Any) -> Measurement:
    sections = CASES[name]
    sections = {**sections, "disorder": {**sections["disorder"], **disorder}}
    return measurement(scene(sections))


def first(m: Measurement, packings: int) -> Sums:
    """Give the sums of the first packings, all solved here, block by block."""
    return reduce(add, (solve_block(m, *block) for block in m.blocks(packings)))


def ensemble_of(m: Measurement, packings: int) -> Ensemble:
    return Ensemble(m, first(m, packings), 0.95)


def bytes_of_first(m: Measurement, packings: int) -> bytes:
    return first(m, packings).to_bytes()
