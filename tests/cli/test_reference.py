"""The reference: every key that a scene takes, every column of an answer, all that Python has."""

import csv
import inspect
import json
import re
from pathlib import Path

import pytest

import force_diffusion as fd

ROOT = Path(__file__).parents[2]
REFERENCE = ROOT / "docs" / "reference"
SCENES = ROOT / "scenes" / "README.md"
SECTIONS = ("packing", "disorder", "load", "effects", "ask")
PACKING = "[packing]\nheight = 2\nwidth = 7\n[disorder]\nkind = 'uniform'\nrelative_std = 1e-3\n"
POINT = "[load]\nkind = 'point'\nat = [0, 2]\n"
MORE = {"contact": "at = [0, 0, '+']\n", "histogram": "bins = 2\n"}
QUANTITIES = ("contact", "contact_forces", "positions", "profile", "histogram", "response")


def _part(page: Path, title: str) -> str:
    """The text below a heading, up to the next one of its level."""
    text = page.read_text(encoding="utf-8")
    part = re.search(
        rf"^(#+) {re.escape(title)}\n(.*?)(?=^\1 |^## |\Z)", text, re.MULTILINE | re.DOTALL
    )
    assert part, title
    return part[2]


def _first_cells(table: str) -> set[str]:
    cells = re.findall(r"^\| (`.*?) \|", table, re.MULTILINE)
    return {name for cell in cells for name in re.findall(r"`(\w+)`", cell)}


def _scene(folder: Path, text: str) -> Path:
    path = folder / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


def _asking(folder: Path, quantity: str, realisations: int = 1, packing: str = PACKING) -> Path:
    load = POINT if quantity == "response" else ""
    asked = f"quantity = '{quantity}'\nrealisations = {realisations}\n{MORE.get(quantity, '')}"
    return _scene(folder, f"{packing}{load}[ask]\n{asked}")


@pytest.mark.parametrize("section", SECTIONS)
def test_documented_keys_are_those_of_a_section(section, tmp_path, refused):
    text = f"{PACKING}[load]\n[effects]\n[ask]\nquantity = 'profile'\n"
    text = text.replace(f"[{section}]", f"[{section}]\nnonsense = 1")
    says = refused("explain", _scene(tmp_path, text))
    allowed = re.search(rf"{section}\.nonsense.*allowed are ([\w, ]+)", " ".join(says.split()))
    assert allowed, says
    assert _first_cells(_part(SCENES, f"`[{section}]`")) == set(allowed[1].strip().split(", "))


def test_sections_and_quantities_are_documented(tmp_path, refused):
    says = refused("explain", _scene(tmp_path, f"{PACKING}[nonsense]\n[ask]\nquantity = 'a'\n"))
    assert {*SECTIONS} <= {*re.findall(r"\w+", says)}
    says = refused("explain", _asking(tmp_path, "nonsense"))
    assert {*re.findall(r'"(\w+)"', says)} - {"nonsense"} == {*QUANTITIES}
    for quantity in QUANTITIES:
        assert f'`"{quantity}"`' in _part(SCENES, "`[ask]`")


@pytest.mark.parametrize("realisations", [1, 3])
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_documented_columns_are_those_of_an_answer(quantity, realisations, tmp_path, printed):
    rows = printed("run", _asking(tmp_path, quantity, realisations)).splitlines()
    columns = set(rows[0].split(","))
    part = _part(SCENES, f"`{quantity}`")
    if quantity == "contact_forces":
        part += _part(SCENES, "`contact`")
    assert columns <= set(re.findall(r"`(\w+)`", part)) | {"realisation"}
    if realisations == 1 and quantity != "response":  # whose columns follow the realisations
        assert _first_cells(part) == columns


@pytest.mark.long
@pytest.mark.usefixtures("only_svg")
def test_documented_columns_are_those_of_a_study_of_costs(tmp_path, printed):
    printed("cost", _asking(tmp_path, "contact"), "--out", tmp_path / "cost")
    with (tmp_path / "cost" / "cost.csv").open(newline="", encoding="utf-8") as file:
        columns = next(csv.reader(file))
    assert _first_cells(_part(REFERENCE / "answers.md", "`cost.csv`")) == set(columns)


def _keys(value: object) -> set[str]:
    """All names of objects within JSON, but those of a scene."""
    if isinstance(value, dict):
        return set(value).union(*(_keys(v) for k, v in value.items() if k != "scene"))
    return set().union(*map(_keys, value)) if isinstance(value, list) else set()


def test_keys_of_json_are_documented(tmp_path, call):
    """Rows of an answer are in it, too, with the names of their columns."""
    pulling = PACKING.replace("1e-3", "0.1").replace("height = 2", "height = 6")
    columns = _part(SCENES, "`contact`") + _part(SCENES, "`contact_forces`")
    commands = [
        ("run", columns, "contact_forces", pulling),
        ("run", columns, "contact", PACKING, "--tolerance", "1e-9"),
        *(("ensemble", "", quantity, PACKING) for quantity in ("profile", "histogram", "response")),
    ]
    for command, more, quantity, packing, *words in commands:
        scene = _asking(tmp_path, quantity, 40 if command == "ensemble" else 1, packing)
        status, stdout, _ = call(command, scene, "--json", *words)
        assert status == 0  # with a warning where contacts pull
        named = re.findall(r"\w+", _part(SCENES, f"The JSON of `{command}`") + more)
        assert _keys(json.loads(stdout)) <= {*named, *QUANTITIES}


def test_documented_commands_are_those_of_the_program(call):
    listed = call("--help")[1].partition("Commands:\n")[2].partition("\n\n")[0]
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


def test_the_page_on_python_names_what_the_package_gives():
    assert {name for name in _described() if hasattr(fd, name)} == set(fd.__all__)


def test_the_page_on_python_gives_members_and_arguments_as_they_are():
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
def test_the_page_on_python_gives_the_fields_of_a_section(section):
    assert _optional(_described()[section.__name__]) == {
        name: not field.is_required() for name, field in section.model_fields.items()
    }
