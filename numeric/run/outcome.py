"""A finished run: the answer as arrays, rows and decimals, its error, and what was physical."""

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ..accuracy import Accuracy, printed
from ..arithmetic.decimals import bound_string, nearest, short
from ..arithmetic.systems import Array
from ..mechanics.physicality import Physicality
from ..planning.plan import Plan
from ..quantities.answer import Answer
from ..quantities.base import Table
from ..scene.scene import source_of
from ..statistics import bins
from ..tables import Answered, Row, rows_of
from ..unilateral.network import Network

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False)
class Result(Answered):
    """The answer to one question, of a ``plan`` that asks it first.

    ``table`` holds the numbers in the arithmetic of the run.
    ``accuracy`` gives the error, relative to the largest change, and whether it is certified.
    ``network``: where beads came to rest under unilateral contacts.
    """

    plan: Plan
    table: Table
    accuracy: Accuracy
    network: Network | None

    @property
    def quantity(self) -> str:
        """The question, by its name in a scene."""
        return self.plan.quantity.name

    @cached_property
    def arrays(self) -> dict[str, Array]:
        """The columns of the answer, each of shape (rows,).

        Numbers are float64, or objects of the arithmetic of the run (mpmath, python-flint's balls)
        where that was longer. Lengths are in the scene's unit, forces in that in which the load's
        magnitude is written. The guide to scenes says what each column means.
        """
        if self.table.bins is not None:
            edges = np.array([*map(nearest, self.table.bins.edges)])
            return {"low": edges[:-1], "high": edges[1:], "count": self.table.bins.counts}
        return self.table.columns

    def rows(self) -> list[Row]:
        """The answer row by row, ready for a data frame; numbers as Python's int and float."""
        return rows_of(self.arrays)

    @cached_property
    def text(self) -> dict[str, list[str]]:
        """The columns of the answer as text: decimals with the digits that are known."""
        if self.table.bins is not None:
            return bins.printed(self.table.bins)
        with (system := self.plan.system).active():
            # a tolerance asks for the digits of these very packings
            sampled = self.plan.tolerance is None
            return printed(self.table, self.accuracy, system, sampled=sampled)

    @property
    def sampling_error(self) -> float | None:
        """The largest standard error of a statistic, relative to the largest change; or None."""
        errors = np.concatenate([np.zeros(0), *self.table.errors.values()])
        largest = errors[np.isfinite(errors)].max(initial=0)
        return float(largest) / self.table.largest if largest and self.table.largest else None

    @property
    def standard_errors(self) -> dict[str, Array]:
        """Standard errors of the columns that are statistics, from the scatter over packings.

        Shape (rows,) each; NaN where there was one packing. Empty where nothing is sampled.
        """
        return self.table.errors

    def plot(self) -> "Figure":
        """Draw this answer; needs matplotlib (the extra ``plots``).

        Contact forces are drawn as force chains, a profile as σ_f beside theory, changes as P(f), a
        response as a map. Raises ``SceneError`` for a quantity that has no figure.
        """
        from ..figures.answers import figure_of

        return figure_of(self.plan, self.arrays, self.standard_errors, self.network)


@dataclass(frozen=True, eq=False, repr=False)
class Outcome(Result):
    """A finished run: the answer to its question (or to the first), with its error and source.

    ``results`` has the answer to each question by its name. ``source`` says where they came from:
    program, version, scene, seed, and the SHA-256 of files read, which ``files`` lists.
    """

    results: dict[str, Result]
    answer: Answer
    seconds: float
    files: dict[str, str]

    @cached_property
    def physical(self) -> Physicality | None:
        """Whether real beads could form this packing; None unless an exact packing was solved.

        ``smallest_gap`` is a float in the unit of the radii: 0 or infinite if it is out of range;
        ``data()`` then has its decimals.
        """
        physical = self.answer.physical
        if physical is None or physical.smallest_gap is None:
            return physical
        gap = _length(physical.smallest_gap, self.plan.scene.packing.radius)
        return replace(physical, smallest_gap=float(gap))

    @cached_property
    def source(self) -> dict[str, Any]:
        """Where the answer came from."""
        return source_of(self.plan.scene, self.files)

    def data(self, *, rows: bool = True) -> dict[str, Any]:
        """Data for JSON; the page *Answers* explains the keys.

        Without ``rows`` the lists of results are empty, since they may have millions of rows. If
        there are several questions, ``accuracy`` is that of the least accurate answer.
        """
        parts = self.results.values()
        accuracy = max((answer.accuracy for answer in parts), key=lambda a: a.error_bound)
        sampling = [answer.sampling_error for answer in parts if answer.sampling_error is not None]
        data = {
            "source": self.source,
            **self.plan.data(),
            "results": {name: a.decimals() if rows else [] for name, a in self.results.items()},
            "accuracy": {
                "error_bound": _bound(accuracy.error_bound),
                "sampling_error": max(sampling, default=None),
                "certified": accuracy.certified,
                "arithmetic": accuracy.arithmetic,
            },
        }
        if accuracy.note:
            data["accuracy"]["note"] = accuracy.note
        if self.answer.physical is not None:
            data["physical"] = _physical_data(self.answer.physical, self.plan)
        if self.answer.network is not None:
            data["network"] = _network_data(self.answer.network)
        data["seconds"] = round(self.seconds, 6)
        return data

    def __str__(self) -> str:
        """Say what was found, how accurately, and what was left out."""
        notes = map("Note: {}".format, self.plan.notes)
        return "\n".join([*outcome_lines(self.data(rows=False)), *notes])

    __repr__ = __str__


def outcome_of(
    plan: Plan, answer: Answer, judged: list[Accuracy], seconds: float, files: dict[str, str]
) -> Outcome:
    """Put the answers to a plan's questions together."""
    results = {}
    for quantity, table, accuracy in zip(plan.quantities, answer.tables, judged, strict=True):
        asked = replace(plan, scene=quantity.scene, quantities=(quantity,))
        results[quantity.name] = Result(asked, table, accuracy, answer.network)
    first = results[plan.quantity.name]
    own = {**vars(first), "plan": plan}
    return Outcome(**own, results=results, answer=answer, seconds=seconds, files=files)


def _physical_data(found: Physicality, plan: Plan) -> dict[str, Any]:
    """Say whether an exact packing is one that beads could make."""
    highest = plan.critical_height
    pulls = found.tensile + found.undecided_signs
    problem, gap = plan.problem, found.smallest_gap
    width, height = problem.width, problem.height
    every = problem.dimension * (width or 0) * height * problem.realisations
    data: dict[str, Any] = {
        "physical": found.sound,
        "whole": problem.region.is_whole and found.contacts == every,
        "smallest_gap": None if gap is None else _length(gap, plan.scene.packing.radius),
        "smallest_gap_between": None if found.between is None else [list(s) for s in found.between],
        "smallest_gap_realisation": found.smallest_in if problem.realisations > 1 else None,
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
        data["first_tensile"] = dict(found.first_tensile)
        if problem.realisations > 1:
            data["first_tensile"]["realisation"] = found.first_tensile_in
    return data


def _length(gap: float, radius: Fraction) -> float | str:
    """Turn units of r into those of the scene: a decimal string where a float can't hold it."""
    if not math.isfinite(gap):
        return gap
    length = Fraction(gap) * radius
    usual = not length or Fraction(1, 10**300) < abs(length) < 10**300
    return float(length) if usual else short(length)


def _network_data(found: Network) -> dict[str, Any]:
    """Say where beads came to rest, and how that is known."""
    return {
        "contacts": len(found.pairs),
        "rattlers": len(found.rattlers),
        "programs": found.programs,
        "energy_fall": found.fall,
        "smallest_gap": found.smallest_gap,
        "kantorovich": found.kantorovich,
        "rest": found.rest,
    }


def _bound(bound: float | Fraction) -> float | str | None:
    """Give a number where a float can hold it, else a decimal string; None stands for infinity."""
    if isinstance(bound, Fraction):
        return bound_string(bound)
    return bound if math.isfinite(bound) else None


def outcome_lines(data: dict[str, Any]) -> list[str]:
    """Say in lines of text what a run found, how accurately, and what was left out."""
    accuracy = data["accuracy"]
    bound = accuracy["error_bound"]
    kind = "certified" if accuracy["certified"] else "estimated"
    shown = f"{bound:.2g}" if isinstance(bound, float) else bound or "unknown"
    error = f"error {shown} ({kind}, {accuracy['arithmetic']})"
    if accuracy["sampling_error"] is not None:
        error = f"sampling error {accuracy['sampling_error']:.2g}; numerical {error}"
    verdict = f"{_physical_words(data['physical'])}; {error}" if "physical" in data else error
    lines = [verdict]
    if "network" in data:
        network = data["network"]
        lines.append(
            f"the packing: {network['rest']}; {network['contacts']} contacts bear force, "
            f"{network['rattlers']} rattlers, smallest gap {network['smallest_gap']:.3g} r"
        )
    if data["skipped"]:
        skipped = "; ".join(f"{s['effect']} ({s['reason']})" for s in data["skipped"])
        lines.append(f"skipped: {skipped}")
    return lines


def _physical_words(p: dict[str, Any]) -> str:
    """Say whether a packing is physical, of how much of it that is known, and why it is not."""
    if p["physical"]:
        if p["tensile_contacts"] is None:
            return "no overlaps; whether contacts pull was not asked"
        return "physical" if p["whole"] else "physical, as far as it was checked"
    words = "NOT physical"
    if not p["overlaps"] and not p["tensile_contacts"]:
        words = "open whether it is physical"
    elif not p["overlaps"] and "note" in p:
        words = "not physical on its own, as with any load on single beads"
    faults = [f"{p['overlaps']} overlaps"] if p["overlaps"] else []
    if p["tensile_contacts"]:
        opens = ', which contacts = "unilateral" lets open' if "i" in p["first_tensile"] else ""
        faults.append(f"{p['tensile_contacts']} of {p['contacts']} contacts are tensile{opens}")
    if p["undecided"]:
        faults.append(f"{p['undecided']} signs open")
    return f"{words}: {', '.join(faults)}"
