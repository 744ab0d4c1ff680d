"""Recording: functions of numbers, called once on names, become straight-line code for a compiler.

Every operation is one line, in the order in which it was called, so that the code rounds as the
function does on arrays of floats, to the bit. What was computed before is not computed again.
"""

from collections.abc import Collection, Sequence
from typing import Any

# Beads that the widest registers hold. Loops take as many at a time; those that are left over at
# the end of a run are taken so, too, together with some before them that are done twice.
WIDE = 8


class Recorder:
    """Takes down operations on names."""

    def __init__(self) -> None:
        """Nothing is known."""
        self.lines: list[str] = []
        self._known: dict[str, Name] = {}

    def name(self, expression: str) -> "Name":
        """Give the name of an expression's value."""
        known = self._known.get(expression)
        if known is None:
            known = self._known[expression] = Name(f"t{len(self._known)}", self)
            self.lines.append(f"{known.text} = {expression}")
        return known


class Name:
    """A number that has a name, in the code that is recorded."""

    __slots__ = ("recorder", "text")

    def __init__(self, text: str, recorder: Recorder) -> None:
        """``text`` is what the code calls it."""
        self.text, self.recorder = text, recorder

    def _with(self, sign: str, other: Any, *, turned: bool = False) -> "Name":
        text = other.text if isinstance(other, Name) else repr(float(other))
        a, b = (text, self.text) if turned else (self.text, text)
        return self.recorder.name(f"{a} {sign} {b}")

    def __add__(self, other: Any) -> "Name":
        return self._with("+", other)

    def __radd__(self, other: Any) -> "Name":
        return self._with("+", other, turned=True)

    def __sub__(self, other: Any) -> "Name":
        return self._with("-", other)

    def __rsub__(self, other: Any) -> "Name":
        return self._with("-", other, turned=True)

    def __mul__(self, other: Any) -> "Name":
        return self if isinstance(other, int) and other == 1 else self._with("*", other)

    def __rmul__(self, other: Any) -> "Name":
        return self.__mul__(other)

    def __truediv__(self, other: Any) -> "Name":
        if isinstance(other, int) and other > 0 and other & (other - 1) == 0:
            return self._with("*", 1 / other)  # the same bits, in less time
        return self._with("/", other)

    def __rtruediv__(self, other: Any) -> "Name":
        return self._with("/", other, turned=True)

    def __neg__(self) -> "Name":
        return self.recorder.name(f"-{self.text}")

    def sqrt(self) -> "Name":
        """Square root."""
        return self.recorder.name(f"sqrt({self.text})")

    def residual(self, a: Any, b: Any, product: Any) -> "Name":
        """Give a b − product, by a fused multiply-add."""
        texts = [x.text if isinstance(x, Name) else repr(float(x)) for x in (a, b, product)]
        return self.recorder.name("fma({}, {}, -{})".format(*texts))


def positive_root(value: Any) -> Any:
    """Record the square root of a number that is not negative but for its rounding."""
    return value.recorder.name(f"sqrt(max({value.text}, 0.0))")


class Code:
    """A function that works on runs of beads, in place; ``text`` is its source.

    It takes flat ``arrays`` (quantities, places), a run, and constants. A run names the place of
    its first bead in each of several rows of beads, and at last how many beads it has: neighbours
    of all of them lie at the same distance. The function gives True where all conditions hold.
    """

    def __init__(self, name: str, arrays: Sequence[str]) -> None:
        """No inputs yet."""
        self.name, self.arrays, self.recorder = name, list(arrays), Recorder()
        self.places: list[str] = []
        self.inputs: list[str] = []
        self.constants: list[str] = []
        self.outputs: list[str] = []
        self.holds: list[str] = []

    def takes(self, array: str, row: int, place: int | None) -> Name:
        """Name a quantity of the beads at a place of the run (None: from the first place on)."""
        name = f"x{len(self.inputs)}"
        self.places.append(_place(f"i{len(self.inputs)}", array, row, place))
        self.inputs.append(f"{name} = taken({array}, i{len(self.inputs)} + q)")
        return Name(name, self.recorder)

    def constant(self) -> Name:
        """Name the next constant."""
        self.constants.append(f"m{len(self.constants)}")
        return Name(self.constants[-1], self.recorder)

    def gives(self, array: str, row: int, place: int | None, value: Any) -> None:
        """Put a value where that quantity belongs. No input is ever put over."""
        k = len(self.outputs)
        self.places.append(_place(f"o{k}", array, row, place))
        self.outputs.append(f"placed({array}, o{k} + q, {value.text}, {k})")

    def demand(self, value: Name, condition: str) -> None:
        """Let the function say False where ``condition`` does not hold of a value."""
        self.holds.append(condition.format(value.text))

    def text(self) -> str:
        """Give the source."""
        lines = [f"def {self.name}({', '.join(self.arrays)}, run, m):", "    alone()"]
        lines += [f"    {name} = m[{k}]" for k, name in enumerate(self.constants)]
        lines += [f"    {name}_ = pitch({name})" for name in self.arrays]
        lines += [f"    {one}" for one in self.places]
        lines += ["    good, n = True, run[-1]", f"    whole = n - n % {WIDE}"]
        lines += ["    for last in range(2 - (whole == n)):"]
        lines += [f"        low, high = (max(n - {WIDE}, 0), n) if last else (0, whole)"]
        lines += ["        for q in range(low, high):"]
        steps = *self.inputs, *self.recorder.lines, *self.outputs
        lines += [f"            {one}" for one in steps]
        if self.holds:
            lines.append(f"            good &= {' & '.join(f'({one})' for one in self.holds)}")
        return "\n".join([*lines, "    return good", ""])


def _place(name: str, array: str, row: int, place: int | None) -> str:
    return f"{name} = {row} * {array}_" + ("" if place is None else f" + run[{place}]")


def module(codes: Sequence[Code], loops: str, called: Collection[str] = ()) -> str:
    """Give the source of several functions, and of the ``loops`` that call them.

    Those that are ``called`` by name are called from Python, too.
    """
    kinds = ["compiled" if code.name in called else "inner" for code in codes]
    texts = [f"@{kind}\n{code.text()}" for kind, code in zip(kinds, codes, strict=True)]
    return "\n\n".join([loops, *texts])
