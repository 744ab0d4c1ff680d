"""Small ensembles for the tests."""

from typing import Any

from force_diffusion.numeric.ensemble.result import Ensemble
from force_diffusion.numeric.ensemble.sums import Measurement, Sums, measurement, solve_block

from tests.numeric.scenes import scene

PROFILE: dict[str, dict[str, Any]] = {
    "packing": {"height": 4, "width": 6},
    "disorder": {"kind": "uniform", "relative_std": "=1e-4", "seed": 5},
    "ask": {"quantity": "profile"},
}
SPHERES: dict[str, dict[str, Any]] = {"packing": {"height": 3, "width": 5, "dimension": 3}}
CASES: dict[str, dict[str, dict[str, Any]]] = {
    "profile": PROFILE,
    "profile of a bulk load": {**PROFILE, "load": {"kind": "bulk"}},
    "profile, first order": {**PROFILE, "effects": {"geometry": "first-order"}},
    "profile below a point load": {**PROFILE, "load": {"kind": "point", "at": [3, 3]}},
    "contact of a slab": {
        **PROFILE,
        "packing": {"height": 5},
        "ask": {"quantity": "contact", "at": [0, 2, "-"]},
    },
    "contact by line sums": {
        **PROFILE,
        "effects": {"geometry": "first-order"},
        "ask": {"quantity": "contact", "at": [0, 2, "+"]},
    },
    "all contacts": {**PROFILE, "ask": {"quantity": "contact_forces"}},
    "response": {
        **PROFILE,
        "packing": {"height": 4},
        "load": {"kind": "point", "at": [0, 4]},
        "ask": {"quantity": "response"},
    },
    "two layers of a response": {
        **PROFILE,
        "load": {"kind": "point", "at": [0, 4]},
        "ask": {"quantity": "response", "layers": [3, 1]},
    },
    "histogram of all": {**PROFILE, "ask": {"quantity": "histogram", "bins": 11}},
    "profile of spheres": {**PROFILE, **SPHERES},
    "bulk profile of spheres": {**PROFILE, **SPHERES, "load": {"kind": "bulk"}},
    "all contacts of spheres": {**PROFILE, **SPHERES, "ask": {"quantity": "contact_forces"}},
    "one contact of spheres": {
        **PROFILE,
        **SPHERES,
        "ask": {"quantity": "contact", "at": [0, 2, 1, "2"]},
    },
    "response of spheres": {
        **PROFILE,
        **SPHERES,
        "load": {"kind": "point", "at": [1, 1, 2]},
        "ask": {"quantity": "response"},
    },
    "histogram of spheres": {**PROFILE, **SPHERES, "ask": {"quantity": "histogram", "bins": 11}},
    "histogram of one": {**PROFILE, "ask": {"quantity": "histogram", "at": [0, 2, "+"]}},
}


def case(name: str, **disorder: Any) -> Measurement:
    sections = CASES[name]
    sections = {**sections, "disorder": {**sections["disorder"], **disorder}}
    return measurement(scene(sections))


def first(m: Measurement, packings: int) -> Sums:
    """Give the sums of the first packings, all solved here, block by block."""
    total = Sums.nothing(m)
    for block in m.blocks(packings):
        total += solve_block(m, *block)
    return total


def ensemble_of(m: Measurement, packings: int) -> Ensemble:
    return Ensemble(m, first(m, packings), 0.95)


def bytes_of_first(m: Measurement, packings: int) -> bytes:
    return first(m, packings).to_bytes()
