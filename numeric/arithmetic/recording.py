"""Recording: functions of numbers, called once on names, become straight-line code for a compiler.

Every operation is one line, in the order in which it was called, so that the code rounds as the
function does on arrays of floats, to the bit. What was computed before is not computed again.
"""

from collections.abc import Sequence
from typing import Any

# Numbers of a strip that lie one after the other; the next quantity begins so much further on.
STRIP = 512


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
    """A function of a strip of beads that is being recorded; ``text`` is its source.

    It takes the strip, (quantities × STRIP,), how many beads are in it, and constants; it replaces
    the first quantities by its outputs and gives True where all conditions hold.
    """

    def __init__(self, name: str) -> None:
        """No inputs yet."""
        self.name, self.recorder = name, Recorder()
        self.inputs: list[str] = []
        self.constants: list[str] = []
        self.outputs: list[Any] = []
        self.holds: list[str] = []

    def quantity(self) -> Name:
        """Name the next quantity of the strip."""
        self.inputs.append(f"x{len(self.inputs)}")
        return Name(self.inputs[-1], self.recorder)

    def quantities(self, count: int) -> tuple[Name, ...]:
        """Name the next ones."""
        return tuple(self.quantity() for _ in range(count))

    def constant(self) -> Name:
        """Name the next constant."""
        self.constants.append(f"m{len(self.constants)}")
        return Name(self.constants[-1], self.recorder)

    def gives(self, *outputs: Any) -> None:
        """Take further outputs."""
        self.outputs += outputs

    def demand(self, value: Name, condition: str) -> None:
        """Let the function say False where ``condition`` does not hold of a value."""
        self.holds.append(condition.format(value.text))

    def text(self) -> str:
        """Give the source."""
        lines = [f"def {self.name}(s, n, m):"]
        lines += [f"    {name} = m[{k}]" for k, name in enumerate(self.constants)]
        lines += ["    good = True", "    for q in range(n):"]
        lines += [f"        {name} = s[q + {k * STRIP}]" for k, name in enumerate(self.inputs)]
        lines += [f"        {line}" for line in self.recorder.lines]
        lines += [
            f"        s[q + {k * STRIP}] = {value.text}" for k, value in enumerate(self.outputs)
        ]
        if self.holds:
            lines.append(f"        good &= {' & '.join(f'({one})' for one in self.holds)}")
        return "\n".join([*lines, "    return good", ""])


def module(codes: Sequence[Code], loops: str) -> str:
    """Give the source of several functions, and of the ``loops`` that call them."""
    return "\n\n".join([loops, *(f"@compiled\n{code.text()}" for code in codes)])
