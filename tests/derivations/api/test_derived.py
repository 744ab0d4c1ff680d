"""``derive`` and ``figure`` of the face: the commands print and write what these give."""

import json

import pytest
from force_diffusion.derivations.framework.catalogue import NoSuchFormError

import force_diffusion as fd


@pytest.mark.long
def test_premises_come_first_and_callbacks_are_called():
    notices: list[str] = []
    finished: list[int] = []
    derived = fd.derive(
        [5], notice=notices.append, finished=lambda o: finished.append(o.derivation.number)
    )
    assert finished == list(derived.verdicts) == [2, 3, 4, 5]
    assert notices[0] == "Eq. 5"
    assert sorted(notices) == [f"Eq. {number}" for number in finished]
    assert derived.proved
    assert derived.counts() == f"{len(finished)} proved"
    assert str(derived).splitlines()[-1] == f"{derived.counts()}."


@pytest.mark.parametrize("number", [0, 17, 5.5, "eleven", None, [11], True])
def test_a_number_that_is_no_equation(number):
    for ask in (fd.equation, lambda label: fd.derive([label])):
        with pytest.raises(NoSuchFormError, match="from 1 to 16, or B1 to B"):
            ask(number)


def test_the_error_for_one_number_in_place_of_a_list_shows_the_call():
    for given in (13, fd.equation(13)):
        with pytest.raises(TypeError, match=r"^derive takes a list of numbers: derive\(\[13\]\)$"):
            fd.derive(given)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"fd\.equation\(13\) gives one"):
        fd.Equation(13)  # type: ignore[arg-type]


@pytest.mark.long
def test_the_command_prints_and_writes_what_derive_gives(tmp_path, call):
    status, stdout, _ = call("derive", 5, "--json", "--out", tmp_path / "out")
    assert status == 0
    derived = fd.derive([5])

    def timeless(data: dict[str, list[dict[str, object]]]) -> object:
        return [{**row, "seconds": 0} for row in data["equations"]]

    assert timeless(json.loads(stdout)) == timeless(derived.data())
    for name, text in derived.latex().items():
        assert (tmp_path / "out" / name).read_text(encoding="utf-8") == text
