"""Writes ``shown.json``, which ``show`` and ``list`` read."""

import json
from collections.abc import Iterable
from importlib import import_module
from typing import Any

from force_diffusion.derivations.export.document import statement_latex
from force_diffusion.derivations.export.plain import heading, statement_text, steps_text
from force_diffusion.derivations.export.shown import DATA
from force_diffusion.derivations.framework.catalogue import load, modules
from force_diffusion.derivations.framework.record import Derivation, ExactView
from force_diffusion.symbolic.printing.code import python_source, sympy_source
from force_diffusion.symbolic.printing.lines import TEXT_WIDTH, latex_body, text_lines
from force_diffusion.symbolic.printing.text import text
from sympy import Eq, Expr


def _value_side(equation: Any) -> Expr:
    """The side that says what the other one is; of a balance, the side that must vanish."""
    return equation.lhs if equation.rhs == 0 else equation.rhs


def _views(derivation: Derivation) -> dict[str, str]:
    sides = [_value_side(equation) for equation in derivation.printed]
    names = [derivation.name]
    if len(sides) > 1:
        names = [f"{derivation.name}_{place}" for place in range(1, len(sides) + 1)]
    functions = [
        python_source(
            name,
            f"Eq. {derivation.number}: "
            + ("what must vanish." if equation.rhs == 0 else f"{text(equation.lhs)}."),
            side,
        )
        for name, side, equation in zip(names, sides, derivation.printed, strict=True)
    ]
    return {
        "text": statement_text(derivation),
        "latex": statement_latex(derivation).rstrip("\n"),
        "sympy": "\n".join(map(sympy_source, sides)),
        "python": "\n\n\n".join(functions),
        "steps": f"{heading(derivation)}\n\n{steps_text(derivation)}",
    }


def _exact_views(derivation: Derivation, place: str, form: ExactView) -> dict[str, str]:
    equation = Eq(form.quantity, form.expression, evaluate=False)
    missed = [f"{where}: {text(value)}" for where, value in form.missed]
    name = f"{derivation.name}_{place.replace('+', '_plus_').replace('-', '_')}"
    note = f"{text(form.quantity)}, exact to first order: {form.validity}"
    if missed:
        note += f"; not for {'; '.join(missed)}"
    lines = [
        f"Eq. {derivation.number}, exact at finite size: {form.validity}",
        "",
        *("  " + line for line in text_lines(equation, room=TEXT_WIDTH - 2)),
    ]
    if missed:
        lines += ["", "Not covered by this form:", *("  " + line for line in missed)]
    return {
        "text": "\n".join(lines),
        "latex": f"\\begin{{equation}}\n{latex_body([equation])}\n\\end{{equation}}",
        "sympy": sympy_source(form.expression),
        "python": python_source(name, f"Eq. {derivation.number}: {note}.", form.expression),
    }


def shown_data(derivations: Iterable[Derivation]) -> str:
    """The content of ``shown.json``."""
    equations = []
    for derivation in derivations:
        entry: dict[str, Any] = {
            "number": derivation.number,
            "name": derivation.name,
            "title": derivation.title,
            "views": _views(derivation),
        }
        module = import_module(f"force_diffusion.derivations.{modules()[derivation.number]}")
        if hasattr(module, "shown_forms"):
            entry["exact"] = {
                place: _exact_views(derivation, place, form)
                for place, form in module.shown_forms().items()
            }
        equations.append(entry)
    return json.dumps({"equations": equations}, indent=1, ensure_ascii=False) + "\n"


def main() -> int:
    """Regenerate the file."""
    DATA.write_text(shown_data(load(number) for number in modules()), encoding="utf-8")
    print(f"wrote {DATA}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
