"""What Coq reads, as files: the theory; what a statement says, and its proof, to be compared."""

import hashlib
import re
from collections.abc import Iterable, Mapping
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


def theory_hash(sources: Mapping[str, str] | None = None) -> str:
    """Hash of the theory, or of such files: of their names and hashes."""
    files = theory() if sources is None else sources
    return sha256("".join(f"{name} {sha256(source)}\n" for name, source in files.items()))


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


HEAD = "Open Scope R_scope.\n"
WORDS = (
    "From Coq Require Import ZArith Reals List.\nImport ListNotations.\n"
    f"From {LIBRARY} Require Import Roots Model.\n"
)
"""All that a statement is read with."""


@dataclass(frozen=True)
class Statement:
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
        theory: the file of ``proofs/`` that holds the tactic.
        about: its ranges and sites, from among the hypotheses.
        disproof: tactics of ``proofs/Counterexamples.v`` that should prove its contrary, if it is
            wrong; nothing where there are none.
        beside: the printed statement, if the disproof needs it, as a lemma of its name.
    """

    name: str
    hypotheses: tuple[str, ...]
    conclusion: str
    tactic: str
    companions: tuple[Companion, ...] = ()
    theory: str = "Certify"
    about: tuple[str, ...] = ()
    disproof: str = ""
    beside: "Statement | None" = None

    @property
    def proposition(self) -> str:
        """All that the theorem says."""
        return "\n".join((*self.hypotheses, f"  {self.conclusion}"))

    @property
    def stated(self) -> str:
        """The file that says it."""
        return words_of(
            {"statement": self.proposition} | {c.name: c.proposition for c in self.companions}
        )

    @property
    def proof(self) -> str:
        """The file that proves it, and the companions."""
        return proof_of(
            self.theory,
            self.statement_in,
            ("Theorem", self.name, "statement", f"{self.tactic}."),
            *(("Lemma", f"{self.name}_{c.name}", c.name, c.proof) for c in self.companions),
        )

    @property
    def acceptance(self) -> str:
        """The file that compares both; it ends by naming the axioms."""
        proved = {self.name: "statement"} | {
            f"{self.name}_{c.name}": c.name for c in self.companions
        }
        return "\n".join(
            (
                f"From {LIBRARY} Require {self.statement_in} {self.module}.",
                *(
                    f"Definition accepted_{says} : {LIBRARY}.{self.statement_in}.{says} :=\n"
                    f"  {LIBRARY}.{self.module}.{name}."
                    for name, says in proved.items()
                ),
                "Print Assumptions accepted_statement.\n",
            )
        )

    @property
    def hash(self) -> str:
        """SHA-256 of all three."""
        return sha256("".join(self.files.values()))

    @property
    def module(self) -> str:
        """The name of the file that proves it; also of ``accepted_in`` without its ending."""
        return self.name.capitalize()

    @property
    def statement_in(self) -> str:
        """The name of the file that says it."""
        return f"{self.module}_statement"

    @property
    def accepted_in(self) -> str:
        """The file in which it is accepted."""
        return self.accepted_file(self.name)

    @staticmethod
    def accepted_file(name: str) -> str:
        """The file in which a theorem is accepted."""
        return f"{name.capitalize()}_accepted.v"

    @property
    def files(self) -> dict[str, str]:
        """Names and sources of the three."""
        return {
            f"{self.statement_in}.v": self.stated,
            f"{self.module}.v": self.proof,
            self.accepted_in: self.acceptance,
        }


def words_of(propositions: Mapping[str, str]) -> str:
    """A file of propositions, by name, which nothing but ``WORDS`` has a say in."""
    return "\n".join(
        (
            f"{WORDS}{HEAD}",
            *(f"Definition {name} : Prop :=\n{says}.\n" for name, says in propositions.items()),
        )
    )


def head_of(theory: str, stated_in: str) -> str:
    """What stands at the head of a file of proofs."""
    return (
        f"From {LIBRARY} Require Import {theory}.\nFrom {LIBRARY} Require {stated_in}.\n"
        f"{HEAD}Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.\n"
    )


def files_of(made: Iterable[Statement]) -> dict[str, str]:
    """Names and sources of all files of several statements."""
    return {name: source for one in made for name, source in one.files.items()}


def proof_of(theory: str, stated_in: str, *proofs: tuple[str, str, str, str]) -> str:
    """A file of proofs: kind, name, which proposition of ``stated_in``, and the proof."""
    return "\n".join(
        (
            head_of(theory, stated_in),
            *(
                f"{kind} {name} : {stated_in}.{says}.\n"
                f"Proof. cbv delta [{stated_in}.{says}]. {proof} Qed.\n"
                for kind, name, says, proof in proofs
            ),
        )
    )
