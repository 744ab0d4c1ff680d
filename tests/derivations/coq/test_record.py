"""The record of Coq's verdicts is about the equations as they are printed now."""

from dataclasses import replace

from force_diffusion.derivations.coq.files import theory_hash
from force_diffusion.derivations.coq.record import record
from force_diffusion.derivations.coq.statements import recorded, statements
from force_diffusion.derivations.export.document import document
from force_diffusion.derivations.framework.catalogue import paper
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic.trees import equation

import force_diffusion as fd


def test_the_record_is_up_to_date():
    """If this fails, ask Coq again: CONTRIBUTING.md says how."""
    assert [row["number"] for row in record()["equations"]] == paper()
    assert record()["theory"] == theory_hash()
    for row in record()["equations"]:
        assert row["accepted"]
        assert row["theorems"] == {made.name: made.hash for made in statements(load(row["number"]))}


def test_only_what_was_accepted_counts(monkeypatch):
    (line,) = load(4).printed
    changed = replace(load(4), printed=(equation(line.lhs, -line.rhs),))
    assert recorded(changed) == "not asked since the equation changed"
    assert [recorded(load(number)) for number in paper()] == ["accepted by Coq 8.16.1"] * 16
    assert recorded(load("B5")) == "not on record"
    for certificate in record()["equations"]:
        monkeypatch.setitem(certificate, "accepted", False)
    assert recorded(load(1)) == "not on record"


def test_lists_and_documents_give_the_verdict_of_coq(call):
    assert "& proved & accepted" in document([run(load(13))])
    assert "accepted by Coq 8.16.1" in call("show", 13)[1]
    assert fd.equation(13).coq == "accepted by Coq 8.16.1"
