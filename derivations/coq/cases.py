"""What stands before a statement's conclusion: packings, loads, forces, and an example of each.

In the words of ``proofs/Model.v``. Of each there is a companion, that such packings exist, and what
a disproof of a wrong statement needs: one of them, with numbers.
"""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import sympy
from force_diffusion.symbolic import symbols as sy

from .files import Companion
from .words import atom


def all_of(conditions: Iterable[str]) -> str:
    """All conditions at once, a line each."""
    return " /\\\n  ".join(conditions)


@dataclass(frozen=True)
class Load:
    """A load in the words of ``Model.v``: what else is quantified on its account, and supposed.

    ``example`` are values of the variables, by name.
    """

    words: str
    variables: str = "(f_load : R)"
    hypotheses: tuple[str, ...] = ("0 < f_load",)
    example: Mapping[str, str] = field(default_factory=lambda: {"f_load": "5"})
    mean: str = ""  # of the force of a contact, where all contacts of a layer and branch have one

    def at(self, values: Mapping[str, str]) -> tuple[list[str], str]:
        """Values of its variables where others have such values; the load itself."""
        of = {name: atom(_with_values(words, values)) for name, words in self.example.items()}
        return [*of.values()], f"({_with_values(self.words, {**values, **of})})"


def _one_force_enters(entering: str, other: str, from_the: str) -> Load:
    """Any loads but on bead (r, s), which one force of the two contacts above it enters."""
    r, s = sy.site_r.in_code, sy.site_s.in_code
    return Load(
        "load",
        "(load : Z -> Z -> vector)",
        (
            f"load {r} {s} = zero",
            f"near (fun e => {other} F {r} {s} e = 0 /\\ {entering} F {r} {s} e <> 0)",
        ),
        {"load": f"single ({r} {from_the} 1) ({s} + 1) 5"},
    )


LOADS = {
    "single": Load("single k l f_load"),
    "surface": Load("surface M f_load", mean="f_load / (2 * n_y G)"),
    "bulk": Load("bulk f_load", mean="(IZR M - IZR j) * (f_load / (2 * n_y G))"),
    "any": _one_force_enters("f_plus", "f_minus", "+"),
    "any, mirrored": _one_force_enters("f_minus", "f_plus", "-"),
    "surface tilted": Load(
        "leaning_surface G M L_plus L_minus",
        "(L_plus L_minus t : R)",
        ("L_minus = t * L_plus",),
        {"L_plus": "2", "L_minus": "6", "t": "3"},
        mean="L_{}",
    ),
}


@dataclass(frozen=True)
class Case:
    """Variables, hypotheses on them, and an example: all that stands before a conclusion.

    ``given`` are variables, and one hypothesis on them, for which the others exist.
    """

    given: str
    supposed: tuple[str, ...]
    variables: str
    hypotheses: tuple[str, ...]
    example: tuple[str, ...]
    law: str = ""  # of the example
    disproof: str = ""  # of a statement about it, with the printed one's name left open

    def before(self) -> tuple[str, ...]:
        """The lines before the conclusion."""
        return (
            " ".join([f"  forall {self.given},", *(f"{one} ->" for one in self.supposed)]),
            f"  forall {self.variables},",
            *(f"  {hypothesis} ->" for hypothesis in self.hypotheses),
        )

    def companion(self, name: str = "is_about_something") -> "Companion":
        """That the hypotheses can be fulfilled."""
        supposed = "".join(f"{one} -> " for one in self.supposed)
        return Companion(
            name,
            f"forall {self.given}, {supposed}\n  exists {self.variables},\n"
            f"  {all_of(self.hypotheses)}",
            f"intros. {self.law}exists {', '.join(self.example)}. something.",
        )


def _with_values(words: str, values: Mapping[str, str]) -> str:
    return re.sub(r"\w+", lambda name: values.get(name[0], name[0]), words)


_DISPROOF = "intros A; specialize (A {}); disprove A"


def one_packing(
    symbols: dict[sympy.Symbol, int], conditions: Iterable[str], load: Load | None
) -> Case:
    """One packing, and its forces under a load, with these indices as an example."""
    indices = {symbol.in_code: f"{value}%Z" for symbol, value in symbols.items()}
    height, laid = indices.pop("M"), "(laid_packing G rho)"
    at = f"trial_lattice trial_radii {height} (trial {height}) {' '.join(indices.values())}"
    case = Case(
        "(G : lattice) (rho : radii)",
        (),
        f"(M : Z) (X : centres) ({' '.join(indices)} : Z)",
        ("packing G M rho X", *conditions),
        (height, laid, *indices.values()),
        disproof=_DISPROOF.format(at),
    )
    if load is None:
        return case
    given = {"M": height, **indices}
    sizes, carried = load.at(given)
    trial = load.at({"G": "trial_lattice", **given})[1]
    return replace(
        case,
        variables=f"{case.variables} (F : forces) {load.variables}",
        hypotheses=(*case.hypotheses, *load.hypotheses, f"carries M X ({load.words}) F"),
        example=(*case.example, f"(passed_down {height} {laid} {carried})", *sizes),
        disproof=_DISPROOF.format(f"{at} (trial_forces {height} {trial}) {' '.join(sizes)}"),
    )


def _beside(*at: str, law: str) -> str:
    """Disproof in a large packing, beside the printed equation, a lemma whose name is left open."""
    same = " ".join(at)
    return (
        f"intros A; pose proof {{}} as T; destruct (law_exists {law}) as [L _];\n"
        f"  specialize (A {same});\n  specialize (T {same}); disprove_beside T A"
    )


def far(heights: int) -> str:
    """No horizontal boundary is met so many heights M to the left and right."""
    reach = "M" if heights == 1 else f"{heights} * M"
    return f"(Z.abs i + {reach} + 2 <= W)%Z"


def random_packings(
    variables: str, conditions: Iterable[str], load: Load, example: dict[str, str]
) -> Case:
    """A family of packings and forces, one for each choice of the radii, and a law of these."""
    height, window, *others = example.values()

    def forces(lattice: str) -> tuple[str, ...]:
        """Those that the load causes, the example's other values, and the load's."""
        sizes, carried = load.at({"G": lattice, **example})
        passed = f"(fun rho => passed_down {height} (laid_packing {lattice} rho) {carried})"
        return (passed, *others, *sizes)

    return Case(
        "(G : lattice) (sigma : R)",
        ("0 < sigma",),
        "(M W : Z) (L : law W M sigma) (Xs : radii -> centres) (Fs : radii -> forces)\n"
        f"    {variables} {load.variables}",
        (
            "(forall rho, packing G M rho (Xs rho))",
            *conditions,
            *load.hypotheses,
            f"(forall rho, carries M (Xs rho) ({load.words}) (Fs rho))",
        ),
        (
            *(height, window, "L", "(laid_packing G)"),
            *forces("G"),
        ),
        f"destruct (law_exists {window} {height} sigma) as [L _]. ",
        _beside(
            f"trial_lattice 1 ltac:(lra) {height} {window} L (laid_packing trial_lattice)",
            *forces("trial_lattice"),
            law=f"{window} {height} 1",
        ),
    )
