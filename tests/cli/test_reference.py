"""The scene reference: every key that a scene takes, and every column that an answer has."""

import csv
import json
import re
from pathlib import Path

import pytest

import force_diffusion as fd
from force_diffusion.__main__ import main

ROOT = Path(__file__).parents[2]
REFERENCE = ROOT / "docs" / "reference"
SCENES = ROOT / "scenes" / "README.md"
STUDIES = REFERENCE / "answers.md"
SECTIONS = ("packing", "disorder", "load", "effects", "ask")
PACKING = "[packing]\nheight = 2\nwidth = 7\n[disorder]\nkind = 'uniform'\nrelative_std = 1e-3\n"
POINT = "[load]\nkind = 'point'\nat = [0, 2]\n"
ASKED = {
    "contact": "quantity = 'contact'\nat = [0, 0, '+']\n",
    "contact_forces": "quantity = 'contact_forces'\n",
    "positions": "quantity = 'positions'\n",
    "profile": "quantity = 'profile'\n",
    "histogram": "quantity = 'histogram'\nbins = 2\n",
    "response": "quantity = 'response'\n",
}


def _part(page: Path, title: str) -> str:
    """What stands below a heading, up to the next one."""
    text = page.read_text(encoding="utf-8")
    found = re.search(rf"^#+ {re.escape(title)}\n(.*?)(?=^#|\Z)", text, re.MULTILINE | re.DOTALL)
    assert found, title
    return found[1]


def _first_cells(table: str) -> set[str]:
    cells = re.findall(r"^\| (`.*?) \|", table, re.MULTILINE)
    return {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}


def _scene(folder: Path, text: str) -> str:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


@pytest.mark.parametrize("section", SECTIONS)
def test_a_section_has_the_keys_that_are_told(section, tmp_path, capsys) -> None:
    whole = {
        "packing": "height = 2",
        "disorder": "kind = 'uniform'\nrelative_std = 1e-3",
        "load": "",
        "effects": "",
        "ask": "quantity = 'profile'",
    }
    whole[section] += "\nnonsense = 1"
    text = "\n".join(f"[{name}]\n{keys}" for name, keys in whole.items())
    assert main(["explain", _scene(tmp_path, text)]) == 2
    message = " ".join(capsys.readouterr().err.split())
    found = re.search(rf"{section}\.nonsense.*allowed are ([\w, ]+)", message)
    assert found, message
    assert _first_cells(_part(SCENES, f"`[{section}]`")) == set(found[1].strip().split(", "))


def test_the_sections_are_told(tmp_path, capsys) -> None:
    assert (
        main(["explain", _scene(tmp_path, f"{PACKING}[nonsense]\n[ask]\n{ASKED['profile']}")]) == 2
    )
    message = " ".join(capsys.readouterr().err.split())
    for section in SECTIONS:
        assert section in message


def test_the_quantities_are_told(tmp_path, capsys) -> None:
    text = "[packing]\nheight = 2\n[ask]\nquantity = 'nonsense'\n"
    assert main(["explain", _scene(tmp_path, text)]) == 2
    message = " ".join(capsys.readouterr().err.split())
    assert set(re.findall(r'"(\w+)"', message)) - {"nonsense"} == set(ASKED)
    for quantity in ASKED:
        assert f'`"{quantity}"`' in _part(SCENES, "`[ask]`")


@pytest.mark.parametrize("realisations", [1, 3])
@pytest.mark.parametrize("quantity", list(ASKED))
def test_an_answer_has_the_columns_that_are_told(quantity, realisations, tmp_path, capsys) -> None:
    load = POINT if quantity == "response" else ""
    text = f"{PACKING}{load}[ask]\nrealisations = {realisations}\n{ASKED[quantity]}"
    assert main(["run", _scene(tmp_path, text)]) == 0
    columns = capsys.readouterr().out.splitlines()[0].split(",")
    part = _part(SCENES, f"`{quantity}`")
    if quantity == "contact_forces":
        part += _part(SCENES, "`contact`")
    told = set(re.findall(r"`(\w+)`", part)) | {"realisation"}
    assert set(columns) <= told
    if realisations == 1 and quantity != "response":  # whose columns follow the realisations
        assert _first_cells(part) == set(columns)


def test_an_ensemble_has_the_columns_that_are_told(tmp_path, capsys) -> None:
    told = set(re.findall(r"`(\w+)`", _part(SCENES, "The JSON of `ensemble`")))
    for quantity in ("profile", "histogram", "response"):
        load = POINT if quantity == "response" else ""
        scene = _scene(tmp_path, f"{PACKING}{load}[ask]\nrealisations = 40\n{ASKED[quantity]}")
        assert main(["ensemble", scene, "--workers", "1"]) == 0
        columns = capsys.readouterr().out.splitlines()[0].split(",")
        assert set(columns) <= told


@pytest.mark.long
def test_a_study_of_costs_has_the_columns_that_are_told(tmp_path, capsys) -> None:
    scene = _scene(tmp_path, f"{PACKING}[ask]\n{ASKED['contact']}")
    assert main(["cost", scene, "--out", str(tmp_path / "cost")]) == 0
    with (tmp_path / "cost" / "cost.csv").open(newline="", encoding="utf-8") as file:
        columns = next(csv.reader(file))
    assert _first_cells(_part(STUDIES, "`cost.csv`")) == set(columns)


def test_every_equation_stands_on_its_page_under_its_title() -> None:
    page = (REFERENCE / "equations.md").read_text(encoding="utf-8")
    titles = re.findall(r"^## (.*)\n\n```.*\n:tags:.*\n\nshow\((\d+)\)$", page, re.MULTILINE)
    assert titles == [(f"Eq. {n}: {fd.equation(n).title}", str(n)) for n in range(1, 17)]


def test_every_command_is_told(capsys) -> None:
    assert main(["--help"]) == 0
    listed = capsys.readouterr().out.partition("Commands:\n")[2].partition("\n\n")[0]
    commands = set(re.findall(r"^  ([\w-]+) ", listed, re.MULTILINE))
    page = (REFERENCE / "commands.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^### `([\w-]+)`$", page, re.MULTILINE)) == commands


def test_every_name_of_the_face_is_told() -> None:
    page = (REFERENCE / "python.md").read_text(encoding="utf-8")
    auto = r"^\.\. auto(?:function|class|exception):: (\w+)(?:\(|$)"
    assert sorted(re.findall(auto, page, re.MULTILINE)) == sorted(fd.__all__)


@pytest.mark.parametrize(
    "section", [fd.Scene, fd.Packing, fd.Disorder, fd.Load, fd.Effects, fd.Ask]
)
def test_a_section_takes_the_fields_that_are_told(section) -> None:
    page = (REFERENCE / "python.md").read_text(encoding="utf-8")
    (signature,) = re.findall(rf"^\.\. autoclass:: {section.__name__}\((.*)\)$", page, re.MULTILINE)
    told = re.findall(r"(\w+)(?:=([^,]+))?(?:, |$)", signature.removeprefix("*, "))
    fields = section.model_fields
    assert {name for name, _ in told} == set(fields)
    assert all(fields[name].is_required() == (not default) for name, default in told)


def _keys(value: object) -> set[str]:
    """All names of objects within JSON, but those of a scene."""
    if isinstance(value, dict):
        return set(value).union(*(_keys(v) for k, v in value.items() if k != "scene"))
    return set().union(*map(_keys, value)) if isinstance(value, list) else set()


def _answers(title: str) -> str:
    text = SCENES.read_text(encoding="utf-8")
    return text.partition(f"\n## {title}\n")[2].partition("\n## ")[0]


def test_the_json_of_a_run_has_the_keys_that_are_told(tmp_path, capsys) -> None:
    pulling = f"{PACKING}[ask]\n{ASKED['contact_forces']}".replace("1e-3", "0.1").replace(
        "height = 2", "height = 6"
    )
    told = set(re.findall(r"\w+", _answers("The JSON of `run`") + _part(SCENES, "`contact`")))
    told |= set(ASKED)
    for text, *more in ((pulling,), (f"{PACKING}[ask]\n{ASKED['contact']}", "--tolerance", "1e-9")):
        assert main(["run", _scene(tmp_path, text), "--json", *more]) == 0
        assert _keys(json.loads(capsys.readouterr().out)) <= told


def test_the_json_of_an_ensemble_has_the_keys_that_are_told(tmp_path, capsys) -> None:
    scene = _scene(tmp_path, f"{PACKING}[ask]\nrealisations = 40\n{ASKED['histogram']}")
    told = set(re.findall(r"\w+", _answers("The JSON of `ensemble`"))) | set(ASKED)
    assert main(["ensemble", scene, "--json"]) == 0
    assert _keys(json.loads(capsys.readouterr().out)) <= told
