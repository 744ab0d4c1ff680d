"""``derive`` and ``figure`` of the face: the commands print and write what these give."""

import json
from pathlib import Path

import pytest
from force_diffusion.derivations.api.equation import NoSuchFormError
from force_diffusion.numeric.figures.catalogue import NoSuchFigureError

import force_diffusion as fd
from force_diffusion.__main__ import main


@pytest.mark.long
def test_premises_come_first_and_callbacks_are_told() -> None:
    told: list[str] = []
    finished: list[int] = []
    found = fd.derive(
        [5], notice=told.append, finished=lambda o: finished.append(o.derivation.number)
    )
    assert finished == list(found.verdicts)
    assert finished[-1] == 5
    assert len(finished) > 1
    assert told[0] == "Eq. 5"
    assert sorted(told) == [f"Eq. {number}" for number in sorted(finished)]
    assert found.proved
    assert found.counts() == f"{len(finished)} proved"
    assert str(found).splitlines()[-1] == f"{found.counts()}."
    assert found._repr_markdown_().count("\n") == len(finished) + 1


@pytest.mark.parametrize("number", [0, 17, 5.5, "17", "eleven", [11]])
def test_a_number_that_is_no_equation(number: object) -> None:
    with pytest.raises(NoSuchFormError, match="give a number from 1 to 16"):
        fd.derive([number])  # type: ignore[list-item]


def test_one_number_in_place_of_several_is_told_in_words() -> None:
    for one in (13, 13.5, "B1", object()):
        with pytest.raises(TypeError, match=r"^derive takes a list: derive\(\["):
            fd.derive(one)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"derive\(\[13\]\)$"):
        fd.derive(fd.equation(13))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"fd\.equation\(13\) gives one"):
        fd.Equation(13)  # type: ignore[arg-type]


@pytest.mark.long
def test_the_command_prints_and_writes_what_derive_gives(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["derive", "5", "--json", "--out", str(tmp_path / "out")]) == 0
    printed = json.loads(capsys.readouterr().out)
    found = fd.derive([5])

    def timeless(data: dict[str, list[dict[str, object]]]) -> object:
        return [{**one, "seconds": 0} for one in data["equations"]]

    assert timeless(printed) == timeless(found.data())
    for name, text in found.latex().items():
        assert (tmp_path / "out" / name).read_text(encoding="utf-8") == text


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        (5, {}, "there is no figure 5"),
        ("3", {"beside": ["double-y"]}, "no model 'double-y' beside figure 3"),
        (4, {"beside": ["x"]}, "no model 'x' beside figure 4"),
        (4, {"realisations": 3}, "from 16 up"),
    ],
)
def test_a_figure_that_can_not_be(name: int | str, options: dict[str, object], words: str) -> None:
    with pytest.raises((NoSuchFigureError, fd.SceneError), match=words):
        fd.figure(name, **options)  # type: ignore[arg-type]
