"""The scene reference: every key that a scene takes, and every column that an answer has."""

import csv
import inspect
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


def test_every_command_is_told(capsys) -> None:
    assert main(["--help"]) == 0
    listed = capsys.readouterr().out.partition("Commands:\n")[2].partition("\n\n")[0]
    commands = set(re.findall(r"^  ([\w-]+) ", listed, re.MULTILINE))
    page = (REFERENCE / "commands.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `(?!force-)([a-z][\w-]+)", page, re.MULTILINE)) == commands


def _described() -> dict[str, str]:
    """The names in the tables of the page on Python, each with its arguments."""
    page = (REFERENCE / "python.md").read_text(encoding="utf-8")
    return dict(re.findall(r"^\| `([\w.]+)(?:\(([^`]*)\))?` \|", page, re.MULTILINE))


def _optional(arguments: str) -> dict[str, bool]:
    """Whether each argument has a default."""
    classes = {"Load": object, "Effects": object, "Path": object}
    parameters = inspect.signature(eval(f"lambda {arguments}: None", classes)).parameters
    return {name: p.default is not p.empty for name, p in parameters.items()}


def test_the_page_on_python_names_what_the_package_gives() -> None:
    assert {name for name in _described() if hasattr(fd, name)} == set(fd.__all__)


def test_the_page_on_python_gives_members_and_arguments_as_they_are() -> None:
    for name, arguments in _described().items():
        owner, _, member = name.partition(".")
        fields = getattr(getattr(fd, owner, None), "__dataclass_fields__", {})
        if owner in fd.__all__ and member not in fields:
            described = getattr(getattr(fd, owner), member) if member else getattr(fd, owner)
            if inspect.isfunction(described):
                # values without names are refused where only *unnamed takes them
                hidden = {"self", "unnamed"}
                names = list(inspect.signature(described).parameters)
                assert list(_optional(arguments)) == [n for n in names if n not in hidden], name


@pytest.mark.parametrize(
    "section", [fd.Scene, fd.Packing, fd.Disorder, fd.Load, fd.Effects, fd.Ask]
)
def test_the_page_on_python_gives_the_fields_of_a_section(section) -> None:
    fields = section.model_fields.items()
    assert _optional(_described()[section.__name__]) == {
        name: not field.is_required() for name, field in fields
    }


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
    columns = _part(SCENES, "`contact`") + _part(SCENES, "`contact_forces`")
    told = set(re.findall(r"\w+", _answers("The JSON of `run`") + columns))
    told |= set(ASKED)
    for text, *more in ((pulling,), (f"{PACKING}[ask]\n{ASKED['contact']}", "--tolerance", "1e-9")):
        assert main(["run", _scene(tmp_path, text), "--json", *more]) == 0
        assert _keys(json.loads(capsys.readouterr().out)) <= told


def test_the_json_of_an_ensemble_has_the_keys_that_are_told(tmp_path, capsys) -> None:
    scene = _scene(tmp_path, f"{PACKING}[ask]\nrealisations = 40\n{ASKED['histogram']}")
    told = set(re.findall(r"\w+", _answers("The JSON of `ensemble`"))) | set(ASKED)
    assert main(["ensemble", scene, "--json"]) == 0
    assert _keys(json.loads(capsys.readouterr().out)) <= told
