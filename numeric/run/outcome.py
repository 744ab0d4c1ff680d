"""A finished run: the answer as arrays, rows and decimals, its error, and what was physical."""

import math
from dataclasses import asdict, dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..accuracy.accuracy import Accuracy
from ..accuracy.digits import strings
from ..arithmetic.decimals import bound_string
from ..arithmetic.systems import Array
from ..lattice.branch import Contact
from ..mechanics.physicality import PHYSICAL, Physicality
from ..mechanics.work import Work
from ..planning.plan import ESTIMATE, Plan, plan_lines
from ..quantities.answer import Answer
from ..statistics import histogram
from ..tables import Row, html_table, rows_of
from ..theory.critical_height import critical_height

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Missed:
    """A method that was tried before the one that answered, and why it did not."""

    algorithm: str
    arithmetic: str
    why: str


@dataclass(frozen=True, eq=False, repr=False)
class Outcome:
    """A finished run.

    ``plan`` is that of the method that answered; ``missed`` are those tried before. ``answer``
    holds the numbers in the arithmetic of the run. ``accuracy`` says how large the error is,
    relative to the largest change, and how it is known.
    """

    plan: Plan
    answer: Answer
    accuracy: Accuracy
    work: Work
    seconds: float
    missed: tuple[Missed, ...] = ()

    @property
    def quantity(self) -> str:
        """What was asked, as the scene calls it."""
        return self.plan.quantity.name

    @property
    def physical(self) -> Physicality | None:
        """Whether beads could make such a packing; None where nothing exact was solved."""
        return self.answer.physical

    @property
    def stopped(self) -> Contact | None:
        """The contact at which a sweep stopped, if it was asked to."""
        return self.answer.stopped

    @cached_property
    def arrays(self) -> dict[str, Array]:
        """The columns of the answer, each of shape (rows,).

        Numbers are float64, or objects of the arithmetic of the run (mpmath, python-flint's balls)
        where that was longer. Lengths are in the scene's unit, forces in that of the load's
        magnitude. The guide to scenes says what each column means.
        """
        if self.answer.bins is not None:
            low, high, count = (
                zip(*self.answer.bins, strict=True) if self.answer.bins else ((), (), ())
            )
            return {
                "low": np.array([float(edge) for edge in low]),
                "high": np.array([float(edge) for edge in high]),
                "count": np.array(count, dtype=np.int64),
            }
        table = self.answer.table
        index = {
            name: np.array(values, dtype=np.float64 if name == "first_order_std" else None)
            for name, values in table.index.items()
        }
        return index | table.numbers

    def rows(self) -> list[Row]:
        """The answer row by row, ready for a data frame; numbers as Python's int and float."""
        return rows_of(self.arrays)

    def decimals(self) -> list[Row]:
        """The answer row by row, numbers as decimal strings with the digits that are known."""
        if self.answer.bins is not None:
            return histogram.printed(self.answer.bins)
        system = self.plan.system
        with system.active():
            printed = strings(self.answer.table, self.accuracy, system)
        columns = {**self.answer.table.index, **printed}
        return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]

    @property
    def standard_errors(self) -> dict[str, Array]:
        """Standard errors of the columns that are statistics, from the scatter over packings.

        Shape (rows,) each; NaN where there was one packing. Empty where nothing is sampled.
        """
        return self.answer.table.errors

    def plot(self) -> "Figure":
        """Draw this answer; needs matplotlib (the extra ``plots``).

        Contact forces are drawn as force chains, a profile as σ_f beside theory, changes as P(f), a
        response as a map. Raises ``SceneError`` for a quantity that has no figure.
        """
        from ..figures.answers import figure_of

        return figure_of(self.plan, self.arrays, self.standard_errors)

    def data(self) -> dict[str, Any]:
        """Give what JSON can hold of it; the guide to scenes has the schema of each quantity."""
        data = self.plan.data()
        work, accuracy = self.work, self.accuracy
        visited = {
            "read radii": work.radii,
            "draw radii": work.radii,
            "deposit": work.deposited,
            "line sums": work.summed,
            "balance forces": work.balanced,
            PHYSICAL: work.checked,
            ESTIMATE: work.again,
        }
        for step in data["plan"]:
            name = step["step"]
            clock = "radii" if name in {"read radii", "draw radii"} else name
            step["seconds"] = round(work.seconds.get(clock, 0.0), 6)
            names = work.arithmetic_again if name == ESTIMATE else work.arithmetic
            step["arithmetic"] = ", then ".join(names)
            step["beads"] = visited.get(name, 0)
        data["results"] = {self.quantity: self.decimals()}
        data["accuracy"] = {
            "error_bound": _bound(accuracy.error_bound),
            "certified": accuracy.certified,
            "arithmetic": accuracy.arithmetic,
            "bits_lost": accuracy.bits_lost,
        }
        if accuracy.note:
            data["accuracy"]["note"] = accuracy.note
        if self.physical is not None:
            data["physical"] = _physical_data(self.physical, self.plan)
        if self.stopped is not None:
            data["stopped_at_tension"] = self.stopped._asdict()
        data["seconds"] = round(self.seconds, 6)
        if data["choice"] is not None:
            data["choice"]["missed"] = [asdict(missed) for missed in self.missed]
            data["choice"]["measured_seconds"] = round(self.seconds, 6)
        return data

    def __str__(self) -> str:
        """Say what was found, how accurately, and what was done for it."""
        return "\n".join(outcome_lines(self.data()))

    __repr__ = __str__

    def _repr_html_(self) -> str:
        """Show the first rows as a table in a notebook."""
        return html_table(self.decimals(), summary_lines(self.data()))


def _physical_data(found: Physicality, plan: Plan) -> dict[str, Any]:
    """Say whether an exact packing is one that beads could make."""
    highest = critical_height(plan.problem.radii.relative_std())
    pulls = found.tensile + found.undecided_signs
    problem = plan.problem
    width, height = problem.width, problem.height
    whole = (
        width is not None
        and problem.region.beads == width * (height + 1)
        and found.contacts == 2 * width * height * problem.realisations
    )
    data: dict[str, Any] = {
        "physical": found.sound,
        "whole": whole,
        "smallest_gap": found.smallest_gap,
        "smallest_gap_between": None if found.between is None else [list(s) for s in found.between],
        "overlaps": found.overlaps,
        "tensile_contacts": found.tensile if found.forces_known else None,
        "undecided": found.undecided_gaps + found.undecided_signs,
        "contacts": found.contacts if found.forces_known else None,
        "height": height,
        "critical_height": highest if math.isfinite(highest) else None,
    }
    loaded = problem.load.loaded
    if pulls and loaded is not None and (width is None or len(loaded) < width):
        data["note"] = (
            "loads on single beads pull contacts inside their cones: such a packing stands when "
            "other loads press these contacts more"
        )
    if found.first_tensile is not None:
        data["first_tensile"] = found.first_tensile._asdict()
    return data


def _physical_line(p: dict[str, Any]) -> str:
    """Say whether a packing is physical, of how much of it that is known, and why."""
    words = "NOT physical"
    if p["physical"]:
        words = "physical" if p["whole"] else "physical, of what was looked at"
    elif not p["overlaps"] and not p["tensile_contacts"]:
        words = "open whether it is physical"
    elif not p["overlaps"] and "note" in p:
        words = "not physical by itself, as below any load on single beads"
    gap = "none" if p["smallest_gap"] is None else f"{p['smallest_gap']:.6g} r"
    pulling = "forces not asked for"
    if p["contacts"] is not None:
        pulling = f"{p['tensile_contacts']} of {p['contacts']} contacts are tensile"
    open_signs = f", {p['undecided']} signs open" if p["undecided"] else ""
    highest = "none" if p["critical_height"] is None else f"{p['critical_height']:.4g}"
    return (
        f"{words}: smallest gap {gap}, {p['overlaps']} overlaps, {pulling}{open_signs}; "
        f"M = {p['height']}, M* = {highest}"
    )


def _bound(bound: float | Fraction) -> float | str | None:
    """Give a number where a float can hold it, else a decimal string; None stands for infinity."""
    if isinstance(bound, Fraction):
        return bound_string(bound)
    return bound if math.isfinite(bound) else None


def outcome_lines(data: dict[str, Any]) -> list[str]:
    """Say in lines of text what a run found and did, without its rows."""
    return [*summary_lines(data), *plan_lines(data)]


def summary_lines(data: dict[str, Any]) -> list[str]:
    """Say how many rows there are, how accurate they are, and what was physical."""
    quantity, rows = next(iter(data["results"].items()))
    accuracy = data["accuracy"]
    bound = accuracy["error_bound"]
    kind = "certified" if accuracy["certified"] else "estimated"
    shown = f"{bound:.2g}" if isinstance(bound, float) else bound or "unknown"
    lines = [
        f"{quantity}: {len(rows)} rows",
        f"error {shown}, {kind}, in {accuracy['arithmetic']}; bits lost {accuracy['bits_lost']}",
    ]
    if "physical" in data:
        lines.append(_physical_line(data["physical"]))
    if "stopped_at_tension" in data:
        contact = data["stopped_at_tension"]
        where = f"i = {contact['i']}, j = {contact['j']}, branch {contact['branch']}"
        lines.append(f"stopped at the tensile contact {where}")
    return lines
