"""Small scenes for the tests, and strategies that draw them."""

import json
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.arithmetic.systems import NumberSystem
from force_diffusion.numeric.disorder import drawing
from force_diffusion.numeric.disorder.radii import Radii
from force_diffusion.numeric.lattice.layers import Rows
from force_diffusion.numeric.mechanics import engine, physicality, sweep
from force_diffusion.numeric.mechanics.engine import solve
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.run.outcome import Outcome
from force_diffusion.numeric.run.running import Scene, run
from force_diffusion.numeric.scene import reading
from hypothesis import strategies as st

import force_diffusion as fd


@contextmanager
def by_numpy() -> Iterator[None]:
    """Let NumPy sweep, as where numba is not installed."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (sweep, physicality):
            patch.setattr(module, "loops", lambda: None)
        patch.setattr(drawing, "_loop", lambda: None)
        patch.setattr(engine, "compiles", lambda *_: False)
        yield


def toml(sections: dict[str, dict[str, Any]]) -> str:
    """Write a scene; fractions must be decimals, given as strings with a leading '='."""
    lines = []
    for name, keys in sections.items():
        lines.append(f"[{name}]")
        for key, value in keys.items():
            exact = isinstance(value, str) and value.startswith("=")
            shown = value[1:] if exact else json.dumps(value)
            lines.append(f"{key} = {shown}")
    return "\n".join(lines) + "\n"


def parse_scene(text: str, folder: Path = Path()) -> Scene:
    return reading.parse_scene(text, Scene, folder)


def scene(sections: dict[str, dict[str, Any]], folder: Path = Path()) -> Scene:
    return parse_scene(toml(sections), folder)


def planned(sections: dict[str, dict[str, Any]], folder: Path = Path()) -> Plan:
    return plan(scene(sections, folder))


def answer(sections: dict[str, dict[str, Any]], folder: Path = Path()) -> Outcome:
    return run(planned(sections, folder))


def basic(height: int = 6, width: int | None = 14, **ask: Any) -> dict[str, dict[str, Any]]:
    packing: dict[str, Any] = {"height": height}
    if width is not None:
        packing["width"] = width
    return {
        "packing": packing,
        "disorder": {"kind": "uniform", "relative_std": "=1e-4", "seed": 3},
        "ask": {"quantity": "contact_forces", **ask},
    }


def listed_loads(folder: Path, rows: Iterable[Sequence[Any]], names: str = "i,j,fx,fy") -> fd.Load:
    """Write a file of loads, and give the load that it is."""
    path = folder / "loads.csv"
    path.write_text("\n".join([names, *(",".join(map(str, row)) for row in rows), ""]))
    return fd.Load(kind="file", file=str(path))


def question(
    quantity: Any, height: int, width: int | None, *, dimension: int = 2, radius: Any = 1,
    spacing: Any = 3, kind: Any = "uniform", std: float = 1e-3, seed: int = 1,
    radii: fd.Disorder | fd.GivenRadii | None = None, load: fd.Load | None = None,
    effects: dict[str, Any] | None = None, folder: Path = Path(), **ask: Any,
) -> fd.Scene:  # fmt: skip
    """Ask something of packings whose radii are drawn, or given as ``radii``."""
    return fd.Scene(
        packing=fd.Packing(
            height=height, width=width, dimension=dimension, radius=radius, spacing=spacing,
            allow_images=True,
        ),
        disorder=radii or fd.Disorder(kind=kind, relative_std=std, seed=seed),
        load=load or fd.SurfaceLoad(),
        effects=fd.Effects(**(effects or {})),
        ask=fd.Ask(quantity=quantity, **ask),
        folder=folder,
    )  # fmt: skip


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, dict[str, Any]]:
    """Scenes of every quantity, load and disorder that can be solved in a moment."""
    dimension = draw(st.sampled_from([2, 2, 3]))
    height = draw(st.integers(1, 6 if dimension == 2 else 3))
    width = draw(st.integers(height + 1, 2 * height + 2))
    sections: dict[str, dict[str, Any]] = {
        "packing": {
            "height": height,
            "width": width,
            "dimension": dimension,
            "spacing": draw(st.sampled_from(["=2.2", "=3.0", "=3.4"][: 5 - dimension])),
        }
    }
    kind = draw(st.sampled_from(["uniform", "normal", "two-point", None]))
    if kind:
        std = draw(st.sampled_from(["=1e-3", "=1e-9", "=1e-200", "=0.0"]))
        seed = draw(st.integers(0, 9))
        sections["disorder"] = {"kind": kind, "relative_std": std, "seed": seed}
    load = draw(st.sampled_from(["surface", "bulk", "point"]))
    sections["load"] = {"kind": load}
    if load == "point":
        sections["load"]["at"] = draw(site(dimension, width, 1, height))
    if draw(st.booleans()):
        sections["load"]["magnitude"] = draw(st.sampled_from(["=3.7", "=4336.69"]))
    if draw(st.booleans()):
        sections["load"]["angle_deg"] = draw(st.integers(-20, 20))
    geometry = draw(st.sampled_from(["ordered", "first-order", "exact"]))
    sections["effects"] = {"geometry": geometry}
    quantities = ["contact", "contact_forces", "positions", "profile", "histogram"]
    if load == "point":
        quantities.append("response")
    quantity = draw(st.sampled_from(quantities))
    sections["ask"] = {"quantity": quantity}
    if quantity == "contact":
        branch = draw(st.sampled_from("+-" if dimension == 2 else "123"))
        sections["ask"]["at"] = [*draw(site(dimension, width, 0, height - 1)), branch]
    if kind and draw(st.booleans()):
        sections["ask"]["realisations"] = draw(st.integers(1, 3))
    return sections


@st.composite
def site(draw: st.DrawFn, dimension: int, width: int, low: int, high: int) -> list[int]:
    j, columns = draw(st.integers(low, high)), st.integers(0, width - 1)
    if dimension == 3:
        return [draw(columns), draw(columns), j]
    return [2 * draw(columns) + j % 2, j]


@dataclass(frozen=True)
class _Noted:
    """Radii that note the sites for which they are asked."""

    radii: Radii
    sites: list[tuple[int, int]] = field(default_factory=list)

    @property
    def relative_std(self) -> Fraction:
        return self.radii.relative_std

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Any:
        self.sites.extend(zip(*(column.tolist() for column in rows.sites), strict=True))
        return self.radii.of(rows, realisations, system)


def radii_read(plan: Plan) -> tuple[Any, list[tuple[int, int]]]:
    """Solve the first realisation, and give the sites of the beads whose radii were read."""
    noted = _Noted(plan.problem.radii)
    with plan.system.active():
        solved = solve(replace(plan.problem, radii=noted), [0], plan.system, Work())
    return solved, list(dict.fromkeys(noted.sites))
