"""The files that Coq reads: the theory, statements, proofs, and a comparison of these two."""

import hashlib
import re
from dataclasses import dataclass
from pathlib import Path

PROOFS = Path(__file__).parents[2] / "proofs"
LIBRARY = "ForceDiffusion"


def sha256(content: str) -> str:
    """Hash of a text."""
    return hashlib.sha256(content.encode()).hexdigest()


def theory() -> dict[str, str]:
    """The hand-written theory: names and sources of its files."""
    return {file.name: file.read_text(encoding="utf-8") for file in sorted(PROOFS.glob("*.v"))}


def theory_hash() -> str:
    """Hash of the theory: of the names and hashes of its files."""
    return sha256("".join(f"{name} {sha256(source)}\n" for name, source in theory().items()))


_IMPORTS = re.compile(rf"^From {LIBRARY} Require (?:Import |Export )?([\w\s]+)\.$", re.MULTILINE)


def imports(source: str) -> list[str]:
    """The files of the theory that a file imports.

    >>> imports("From ForceDiffusion Require Import Model Sums.")
    ['Model.v', 'Sums.v']
    """
    return [f"{name}.v" for names in _IMPORTS.findall(source) for name in names.split()]


@dataclass(frozen=True)
class Companion:
    """A proposition about the hypotheses of a statement, and its proof."""

    name: str
    proposition: str
    proof: str


WORDS = (
    "From Coq Require Import ZArith Reals.\n"
    f"From {LIBRARY} Require Import Roots Model.\nOpen Scope R_scope.\n"
)
"""All that a statement is read with."""


@dataclass(frozen=True)
class CoqStatement:
    """One printed equation in Coq, in three files.

    The first imports nothing but the words of ``Model.v`` and ``Roots.v``: no other file of the
    theory can change what it says. The second proves it. The third imports neither; in it what was
    proved is what was stated, and the axioms that this rests on are named.

    Attributes:
        name: of the theorem.
        hypotheses: what it is about.
        conclusion: what it says then.
        tactic: of ``proofs/Certify.v``, which should prove it.
        companions: that the hypotheses can be fulfilled, and that no sum's bounds are reversed
            under them (SymPy reads such sums in another way).
        about: its ranges and sites, from among the hypotheses.
    """

    name: str
    hypotheses: tuple[str, ...]
    conclusion: str
    tactic: str
    companions: tuple[Companion, ...] = ()
    about: tuple[str, ...] = ()

    @property
    def proposition(self) -> str:
        """All that the theorem says."""
        return "\n".join((*self.hypotheses, f"  {self.conclusion}"))

    @property
    def parts(self) -> tuple[Companion, ...]:
        """The statement itself, and the companions."""
        return (Companion("statement", self.proposition, f"{self.tactic}."), *self.companions)

    @property
    def statement(self) -> str:
        """The file that says it."""
        definitions = (f"Definition {p.name} : Prop :=\n{p.proposition}.\n" for p in self.parts)
        return "\n".join((WORDS, *definitions))

    @property
    def proof(self) -> str:
        """The file that proves it, and the companions."""
        return (
            f"From {LIBRARY} Require Import Certify.\nFrom {LIBRARY} Require {self.statement_in}.\n"
            "Open Scope R_scope.\nLtac Zify.zify_post_hook ::= Z.div_mod_to_equations.\n"
        ) + "".join(
            f"\nTheorem {part.name} : {self.statement_in}.{part.name}.\n"
            f"Proof. cbv delta [{self.statement_in}.{part.name}]. {part.proof} Qed.\n"
            for part in self.parts
        )

    @property
    def acceptance(self) -> str:
        """The file that compares both, and names the axioms."""
        accepted = [f"accepted_{part.name}" for part in self.parts]
        compared = (
            f"Definition {name} : {LIBRARY}.{self.statement_in}.{part.name} :=\n"
            f"  {LIBRARY}.{self.module}.{part.name}.\n"
            for name, part in zip(accepted, self.parts, strict=True)
        )
        return (
            f"From {LIBRARY} Require {self.statement_in} {self.module}.\n{''.join(compared)}"
            f"Definition accepted := ({', '.join(accepted)}).\nPrint Assumptions accepted.\n"
        )

    @property
    def hash(self) -> str:
        """SHA-256 of all three."""
        return sha256("".join(self.files.values()))

    @property
    def module(self) -> str:
        """The name of the file that proves it."""
        return self.name.capitalize()

    @property
    def statement_in(self) -> str:
        """The name of the file that says it."""
        return f"{self.module}_statement"

    @property
    def accepted_in(self) -> str:
        """The name of the file in which it is accepted."""
        return f"{self.module}_accepted"

    @property
    def files(self) -> dict[str, str]:
        """Names and sources of the three."""
        return {
            f"{self.statement_in}.v": self.statement,
            f"{self.module}.v": self.proof,
            f"{self.accepted_in}.v": self.acceptance,
        }
