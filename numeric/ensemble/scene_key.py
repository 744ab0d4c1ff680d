"""What an ensemble is, as plain data: all that decides its numbers, and nothing else."""

import hashlib
import json
from contextlib import suppress
from fractions import Fraction
from typing import Any

from ..arithmetic.decimals import short
from ..scene.scene import PROGRAM, program_version
from .measure import Measurement

# Keys of a scene that say how much is asked, not what.
_NOT_IN_IT = {"ask": {"realisations", "tolerance", "bins"}}


def ensemble_key(m: Measurement) -> dict[str, Any]:
    """Describe the ensemble of a measurement; numbers are exact, as strings."""
    scene = m.plan.scene
    sections = scene.model_dump(exclude={"folder": True, **_NOT_IN_IT})
    sections["packing"]["spacing"] = scene.spacing
    if scene.load.file is not None:  # its content counts, not its name
        loads = m.problem.load.single.items()
        forces = sorted((list(site), list(map(str, force))) for site, force in loads)
        digest = hashlib.sha256(json.dumps(forces).encode()).hexdigest()
        sections["load"]["file"] = f"sha256 {digest}"
    key: dict[str, Any] = json.loads(json.dumps(sections, default=str))  # of fractions
    key["measured"] = {"edges": [edge.hex() for edge in m.edges]}
    key["version"] = {PROGRAM: program_version()}
    return key


def differences(old: dict[str, Any], new: dict[str, Any]) -> str:
    """Name the first few keys in which two ensembles differ."""
    found = []
    for section in {**old, **new}:
        a, b = old.get(section) or {}, new.get(section) or {}
        if not isinstance(a, dict) or not isinstance(b, dict):
            continue
        for name in {**a, **b}:
            if a.get(name) != b.get(name):
                found.append(f"there {section}.{name} is {_shown(a.get(name))}, "
                             f"here {_shown(b.get(name))}")  # fmt: skip
    return "; ".join(found[:3]) or "its description is another"


def _shown(value: Any) -> str:
    if isinstance(value, str):
        with suppress(ValueError):
            return short(Fraction(value))
    text = "not given" if value is None else json.dumps(value)
    return text if len(text) <= 50 else text[:47] + "…"
