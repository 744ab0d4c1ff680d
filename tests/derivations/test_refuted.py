"""What the paper prints of one contact below a load: refuted, as expected, and said everywhere."""

import pytest
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.api.derived import Derived
from force_diffusion.derivations.api.proof import Proof
from force_diffusion.derivations.export import terminal
from force_diffusion.derivations.framework import runner
from force_diffusion.derivations.framework.proof import Steps
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.limits import asymptotic
from force_diffusion.symbolic.trees import equation


def test_the_printed_statement_for_one_contact_is_refuted_and_no_failure():
    derivation = load(16)
    (reading,) = derivation.proof.refuted
    assert reading.formula.rhs == derivation.printed[0].rhs
    assert reading.domain.relation == "∼"
    assert "goes to (j + n)/(2 j + n + q), not to 1" in reading.reason


def test_what_holds_for_one_contact_is_not_refuted():
    proof = Steps(16, eq16.CONE, eq16.MEANING)
    claims = {claim.reason: claim.formula for claim in load(16).proof.claims}
    (words,) = (reason for reason in claims if reason.startswith("to leading order"))
    of_contact = claims[words].rhs
    rule = asymptotic(*eq16.in_radii())
    for rhs in (of_contact, of_contact * (1 + 1 / sy.l)):
        with pytest.raises(NotProvedError, match="was to be refuted"):
            proof.refute("true", equation(eq16.ONE_CONTACT, rhs), rule, eq16.CONE)


def test_every_report_of_the_run_counts_it():
    outcome = runner.run(load(16))
    words = "1 printed statement refuted, as expected (see ERRATA)"
    derived, proof = Derived((outcome,)), Proof((outcome,))
    assert outcome.verdict is proof.verdict is Verdict.PROVED
    assert derived.proved
    assert derived.counts() == f"1 proved; {words}"
    assert [check.kind for check in proof.refuted] == ["refutation"]
    for summary in (str(derived), str(proof), terminal.outcome_text(outcome)):
        assert words in summary
    assert len(terminal.summary_text(outcome).splitlines()) == 1
    (row,) = derived.data()["equations"]
    assert row["refuted as expected"] == 1
    assert [c["verdict"] for c in row["checks"] if c["kind"] == "refutation"] == ["refuted"]
    (reading,) = outcome.derivation.proof.refuted
    for document in (derived.latex()["equations.tex"], terminal.outcome_text(outcome)):
        assert reading.reading[1:] in " ".join(document.split())  # a sentence, or part of one
