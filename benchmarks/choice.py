"""Measure the choice that a tolerance leads to: how good predictions and choices are.

    python benchmarks/choice.py [--most SECONDS] [--json FILE]

Calibrates, without storing anything; takes some four minutes of the processor. The chosen way is
run, and every other that may answer, if it is predicted to take no more than ``--most`` seconds;
these are seconds of the processor, which other programs on the machine change least. The chosen way
is called best if no other that met the tolerance took less than it, by more than runs differ (a
tenth).
"""

import argparse
import json
import math
import statistics
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from time import process_time
from typing import Any

from force_diffusion.numeric.planning.cost_model import Model
from force_diffusion.numeric.planning.plan import Candidate, Plan
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.run import Outcome, run
from force_diffusion.numeric.scene.sections import parse_scene
from force_diffusion.numeric.studies.calibrating import calibrate

RUNS, ALIKE = 2, 1.1
EVERY = ("1e-3", "1e-10", "1e-13", "1e-16", "1e-30", "1e-100")
SOME, FLOATS = ("1e-3", "1e-13", "1e-30"), ("1e-3", "1e-12")


def scenes() -> Iterator[tuple[str, str, tuple[str, ...]]]:
    """Name and text of each scene, without its tolerance, and the tolerances to try."""
    disorder = 'disorder = {kind = "uniform", relative_std = 1e-6, seed = 1}'
    for height, width, tolerances in ((8, 20, EVERY), (32, 70, SOME), (96, 200, SOME)):
        packing = f"packing = {{height = {height}, width = {width}}}\n{disorder}\n"
        for quantity in ("contact_forces", "positions", "profile", "base_reactions"):
            ask = f'ask = {{quantity = "{quantity}"'
            yield f"{quantity} {height} x {width}", packing + ask, tolerances
    for height, width in ((300, 700), (700, 1430)):
        packing = f"packing = {{height = {height}, width = {width}}}\n{disorder}\n"
        for quantity in ("profile", "base_reactions"):
            ask = f'ask = {{quantity = "{quantity}"'
            yield f"{quantity} {height} x {width}", packing + ask, FLOATS
    for height in (8, 32, 100):
        one = f"packing = {{height = {height}}}\n{disorder}\n"
        contact = 'ask = {quantity = "contact", at = [0, 2, "+"]'
        yield f"contact, slab {height}", one + contact, EVERY
        many = f"{contact}, realisations = 50"
        first = 'effects = {geometry = "first-order"}\n'
        yield f"first-order contact, slab {height}, 50", one + first + many, SOME
        yield f"contact, slab {height}, 50", one + many, SOME
    for height, width in ((16, 40), (48, 100)):
        packing = f"packing = {{height = {height}, width = {width}}}\n{disorder}\n"
        ask = 'ask = {quantity = "profile", realisations = 40'
        yield f"profile {height} x {width}, 40", packing + ask, SOME


def only(made: Plan, way: Candidate) -> Plan:
    """Give the plan of one way, without any to fall back on."""
    assert made.choice is not None
    assert way.plan is not None
    return replace(way.plan, choice=replace(made.choice, candidates=(way,)))


def quickest(made: Plan) -> tuple[float, Outcome]:
    """Run a few times, once if that takes long; give the least seconds, and the outcome."""
    least = math.inf
    for _ in range(RUNS if made.estimated_seconds < 1 else 1):
        start = process_time()
        outcome = run(made)
        least = min(least, process_time() - start)
    return least, outcome


def measured(model: Model, text: str, tolerance: str, most: float) -> list[dict[str, Any]]:
    """Run every way that may answer; the chosen one is the first row."""
    made = plan(parse_scene(f"{text}, tolerance = {tolerance}}}\n"), model=model)
    assert made.choice is not None
    rows = []
    for way in made.choice.candidates:
        if way.out or (rows and (way.seconds or 0) > most):
            continue
        try:
            seconds, outcome = quickest(only(made, way))
        except ArithmeticError as error:
            rows.append({**named(way), "measured": None, "met": False, "why": str(error)})
            continue
        met = Fraction(outcome.accuracy.error_bound) <= made.choice.tolerance
        rows.append({**named(way), "measured": seconds, "met": met, "why": ""})
    return rows


def named(way: Candidate) -> dict[str, Any]:
    """Give what a row says of a way before it runs."""
    return {
        "algorithm": way.algorithm,
        "arithmetic": way.arithmetic,
        "repeated": way.repeated,
        "predicted": way.seconds,
    }


def _spread(factors: list[float]) -> str:
    return f"{statistics.median(factors):.3g} (median), {max(factors):.3g} (worst)"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--most", type=float, default=0.7, help="seconds that another way may take")
    parser.add_argument("--json", type=Path, help="also write every row into this file")
    options = parser.parse_args()
    model = calibrate()
    every, off, taken, best, lost, missed = [], [], [], 0, [], 0
    cases = 0
    for name, text, tolerances in scenes():
        for tolerance in tolerances:
            rows = measured(model, text, tolerance, options.most)
            if not rows:
                continue
            every.append({"scene": name, "tolerance": tolerance, "ways": rows})
            off += [max(r["predicted"] / r["measured"], r["measured"] / r["predicted"])
                    for r in rows if r["measured"]]  # fmt: skip
            missed += sum(not r["met"] for r in rows)
            good = [r["measured"] for r in rows if r["met"]]
            chosen = rows[0]
            if not chosen["met"]:
                continue
            taken.append(chosen["predicted"] / chosen["measured"])
            loss = chosen["measured"] / min(good)
            if len(good) > 1:
                cases += 1
                lost.append(loss)
                best += loss <= ALIKE
            print(
                f"{name:<36}{tolerance:>7}  {chosen['arithmetic']:<20} predicted "
                f"{chosen['predicted']:.2e} s, took {chosen['measured']:.2e} s, "
                f"{loss:.2f} times the quickest of {len(good)}",
                flush=True,
            )
    print(f"{len(off)} ways were run; {missed} of them missed the tolerance")
    print(f"predicted against measured: factor {_spread(off)}")
    within = sum(0.5 <= ratio <= 2 for ratio in taken)
    print(
        f"of the chosen ways, predicted over measured is {min(taken):.2f} to {max(taken):.2f}, and "
        f"within a factor 2 in {within} of {len(taken)}"
    )
    print(f"the chosen way was the quickest, or within a tenth of it, in {best} of {cases} choices")
    print(f"time against that of the quickest way: factor {_spread(lost)}")
    if options.json:
        options.json.write_text(json.dumps(every, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
