"""Derivations of a user's own, from a Python file that is run by an explicit command.

The file states ``DERIVATION``, or several as ``DERIVATIONS``, by their labels. It is run as
``python`` would run it; what goes wrong in it is told by line, without a traceback.
"""

import re
import sys
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType

import sympy
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic.kernel.theorem import Theorem
from force_diffusion.symbolic.printing.latex import RELATIONS

from .catalogue import Number, cases_of, modules
from .loading import load, with_premises
from .proving import Lines
from .record import Derivation, Witness

_MISTAKES = (
    ArithmeticError, AssertionError, AttributeError, LookupError, RuntimeError, TypeError,
    ValueError,
)  # fmt: skip

_LABEL = re.compile(r"[A-Z][A-Za-z0-9]{0,11}", re.ASCII)


class OwnDerivationError(ForceDiffusionError, ValueError):
    """A user's derivation, or the file that holds it, is not what it has to be."""


def is_own(derivation: Derivation) -> bool:
    """Whether it is none of this package's."""
    return derivation.number not in modules() or load(derivation.number) is not derivation


def assert_allowed(derivation: Derivation) -> None:
    """Refuse labels that other equations have, or that can't be those of files.

    Raises:
        OwnDerivationError: that of the derivation, or of one that it rests on, is not allowed.
    """
    if not is_own(derivation):
        return
    number = derivation.number
    if number in modules() or cases_of(number):
        raise OwnDerivationError(f"number = {number!r} is taken: give a label of your own")
    if not isinstance(number, str) or not _LABEL.fullmatch(number):
        allowed = 'a capital letter, then at most 11 letters or digits, such as "S1"'
        raise OwnDerivationError(f"number = {number!r}: {allowed}")
    for right, field, allowed in (
        (_is_word(derivation.name), "name", 'a word for code, such as "sum_of_two_forces"'),
        (_are(derivation.printed, sympy.Eq), "printed", "a tuple of equations, as (printed,)"),
        (callable(derivation.steps), "steps", "a function that gives Lines"),
        (_is_function(derivation.exact), "exact", "a function, as variance.exact, not called"),
        (derivation.relation in RELATIONS, "relation", f"one of {' '.join(RELATIONS)}"),
        (_are(derivation.premises, Derivation), "premises", "derivations, as (premise(11),)"),
        (_are(derivation.witnesses, Witness), "witnesses", "a tuple of witnesses"),
        (_are(derivation.symbols, tuple), "symbols", "pairs of a symbol and its meaning"),
    ):
        if not right:
            raise OwnDerivationError(f"{field} of {number}: {allowed}")
    for premise in derivation.premises:
        assert_allowed(premise)


def assert_shown(derivation: Derivation) -> None:
    """Refuse a derivation none of whose lines is what it prints, or proves it with its sign.

    Raises:
        OwnDerivationError: it is such a one.
    """
    lines = derivation.steps()
    if not isinstance(lines, Lines):
        raise OwnDerivationError(f"steps of {derivation.number}: a function that gives Lines")
    shown = [one for line in lines for one in line.equations]
    if is_own(derivation) and not all(one in shown for one in derivation.printed):
        raise OwnDerivationError(
            f"printed of {derivation.number}: no line of its steps shows it; add one, as "
            "variance.show_leading(lines, reason, printed)"
        )
    for part in range(len(derivation.printed)) if is_own(derivation) else ():
        if reason := derivation.unlike(part):
            raise OwnDerivationError(reason)


def premises_unnamed(derivation: Derivation) -> list[Number]:
    """Printed equations whose theorems its own rest on, and that it does not name as premises.

    Of one that rests on another the last alone.
    """
    known: dict[int, Theorem] = {}
    ahead = [theorem for line in derivation.steps() for theorem in line.theorems]
    while ahead:
        theorem = ahead.pop()
        if id(theorem) not in known:
            known[id(theorem)] = theorem
            ahead += theorem.premises
    named = {one.number for one in with_premises([derivation])}
    found = [
        load(number)
        for number, module in modules().items()
        if number not in named and f"force_diffusion.derivations.{module}" in sys.modules
    ]  # what is not loaded was not used
    used = [one for one in found if any(id(theorem) in known for theorem in one.theorems)]
    below = {one.number for used_one in used for one in with_premises(used_one.premises)}
    return [one.number for one in used if one.number not in below]


def _is_word(name: object) -> bool:
    return isinstance(name, str) and name.isidentifier()


def _is_function(exact: object) -> bool:
    return exact is None or callable(exact)


def _are(several: object, kind: type) -> bool:
    return isinstance(several, tuple) and all(isinstance(one, kind) for one in several)


def derivations_in(path: Path) -> list[Derivation]:
    """Run a file and give the derivations that it states.

    Raises:
        OwnDerivationError: it is not there, fails, or states none; the message says where.
    """
    with blamed_on(path):
        try:
            source = path.read_bytes()
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise OwnDerivationError(f"{path} can't be read: {reason}") from None
        try:
            code = compile(source, str(path), "exec")
        except SyntaxError as error:
            place = f", line {error.lineno}" if error.lineno else ""
            raise OwnDerivationError(f"{path.name}{place}: {error.msg}") from None
        except ValueError as error:  # a zero byte, before Python 3.12
            raise OwnDerivationError(f"{path.name}: {error}") from None
        module = ModuleType(f"own_{path.stem}")
        module.__file__ = str(path)
        sys.modules[module.__name__] = module  # as dataclasses in it need
        sys.path.append(str(path.parent.resolve()))  # for what lies beside it
        try:
            exec(code, module.__dict__)
        finally:
            sys.path.pop()
    stated = getattr(module, "DERIVATIONS", None) or getattr(module, "DERIVATION", None)
    named = list(stated.values()) if isinstance(stated, Mapping) else [stated]
    found = [one for one in named if isinstance(one, Derivation)]
    if not found or len(found) < len(named):
        raise OwnDerivationError(
            f"{path.name} states no derivation: let it hold DERIVATION = Derivation(…), or "
            "DERIVATIONS, a dictionary of several by their labels"
        )
    try:
        for one in found:
            assert_allowed(one)
    except OwnDerivationError as error:
        error.add_note(path.name)
        raise
    return found


@contextmanager
def blamed_on(*paths: Path) -> Iterator[None]:
    """Tell what goes wrong in a user's files by line, in place of a traceback.

    Raises:
        OwnDerivationError: something went wrong with a line of a file on the way.
    """
    try:
        yield
    except ForceDiffusionError:
        raise
    except (Exception, SystemExit) as error:
        lines = {str(path): path.name for path in paths}
        frames = traceback.extract_tb(error.__traceback__)
        own = [frame for frame in frames if frame.filename in lines]
        if not own and isinstance(error, _MISTAKES) and paths:
            names = " or ".join(lines.values())
            what = f"what {names} states can't be run: {type(error).__name__}: {error}"
            raise OwnDerivationError(what) from error
        if not own:
            raise
        what = "it ends the program" if isinstance(error, SystemExit) else str(error)
        place = f"{lines[own[-1].filename]}, line {own[-1].lineno}"
        raise OwnDerivationError(f"{place}: {type(error).__name__}: {what}") from error
