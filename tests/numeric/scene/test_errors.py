"""What is wrong with a scene or its files is said, with the key, the value and what is allowed."""

import json
import os
import string
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.accuracy import ToleranceError
from force_diffusion.numeric.disorder.radii import RadiusError
from force_diffusion.numeric.mechanics.sweep import NotStandingError, UnbuildableError
from force_diffusion.numeric.run import read_scene, run
from force_diffusion.numeric.scene.files import TableError
from force_diffusion.numeric.scene.sections import SceneError
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import answer, basic, parse_scene, planned, scene

WRONG: list[tuple[str, str, Any, str]] = [
    ("packing", "height", 0, "at least 1"),
    ("packing", "allow_images", "=1.50", "boolean"),
    ("packing", "height", "=2.0", "whole number"),
    ("packing", "height", 10**30, "at most"),
    ("packing", "width", 6, "allow_images"),
    ("packing", "spacing", "=2.0", "strictly between"),
    ("packing", "spacing", "=3.4641016151378", "strictly between"),
    ("packing", "spacing", "=-3.0", "strictly between"),
    ("packing", "spacing", "=nan", "finite"),
    ("packing", "spacing", "=inf", "finite"),
    ("packing", "spacing", "three", "must be a number"),
    ("packing", "radius", 0, "greater than 0"),
    ("packing", "radius", True, "must be a number"),
    ("packing", "radius", "=1e999999", "exponent"),
    ("packing", "hieght", 4, 'did you mean "height"'),
    ("disorder", "kind", "unifrom", 'did you mean "uniform"'),
    ("disorder", "kind", "gaussian", 'did you mean "normal"'),
    ("disorder", "relative_std", "=-1e-3", "at least 0"),
    ("disorder", "relative_std", "=0.58", "radius ≤ 0"),
    ("disorder", "seed", -1, "at least 0"),
    ("disorder", "seed", 2**64, "less than"),
    ("disorder", "file", "radii.csv", 'needs kind = "file"'),
    ("load", "kind", "surfaces", 'did you mean "surface"'),
    ("load", "magnitude", 0, "greater than 0"),
    ("load", "angle_deg", 181, "at most 90"),
    ("load", "at", "+", "a bead, [i, j]"),
    ("load", "at", [1, 1], 'needs kind = "point"'),
    ("effects", "geometry", "exakt", 'did you mean "exact"'),
    ("effects", "most_programs", 0, "at least 1"),
    ("effects", "most_seconds", "=1.50", 'contacts = "unilateral"'),
    ("ask", "quantity", "forces", "must be one of"),
    ("ask", "tolerance", 0, "greater than 0"),
    ("ask", "tolerance", 1, "less than 1"),
    ("ask", "realisations", 0, "at least 1"),
    ("ask", "bins", 5, 'needs quantity = "histogram"'),
    ("ask", "layers", [0], 'needs quantity = "response"'),
    ("ask", "layers", [0.5], "a list of layers"),
    ("ask", "at", [0, 0, "+"], 'needs quantity = "contact", "histogram" or "positions"'),
]


@pytest.mark.parametrize(("section", "key", "value", "says"), WRONG)
def test_errors_name_the_key_and_what_is_allowed(
    section: str, key: str, value: Any, says: str
) -> None:
    sections = basic()
    sections.setdefault(section, {})[key] = value
    with pytest.raises(SceneError) as caught:
        scene(sections)
    assert f"{section}.{key}" in str(caught.value)
    assert says in str(caught.value)


def test_columns_of_a_slab_may_be_negative() -> None:
    planned(basic(4, None, quantity="contact", at=[-3, 1, "+"]))
    for i in (-(2**60), 2**60):
        with pytest.raises(SceneError, match=r"above -2\^60 and below 2\^60"):
            scene(basic(4, None, quantity="contact", at=[i, 0, "+"]))


@pytest.mark.parametrize(
    ("at", "says"),
    [
        ([0, 0], "must be a contact"),
        ([0, 0, "x"], "must be a contact"),
        ([0, 1, "+"], "even"),
        ([0, 6, "+"], "j must be from 0 to 5"),
        ([28, 0, "+"], "i must be from 0 to 27"),
        (["a", 0, "+"], "must be a contact"),
    ],
)
def test_contacts_outside_the_packing(at: list[Any], says: str) -> None:
    with pytest.raises(SceneError, match=says):
        scene(basic(quantity="contact", at=at))


def test_missing_sections_and_keys() -> None:
    for text, says in [
        ("", r"section \[packing\] is required"),
        ("[packing]\nheight = 3\n", r"section \[ask\] is required"),
        ("[packing]\n[ask]\nquantity = 'contact'\n", "packing.height is required"),
        ("[packing]\nhieght = 3\n[ask]\nquantity = 'profile'", 'hieght: .* mean "height"'),
        ("[packing]\nheight = 3\n[ask]\nquantitiy = 'profile'", 'quantitiy: .* mean "quantity"'),
        ("packing = 3\n", "must be a section"),
        ("[packing\n", "is not a scene, which is a TOML file"),
        ("a = " + "[" * 5000, "nested too deeply"),
        ("[packing]\nheight = 1" + "0" * 6000, "more than 4300 digits"),
        ("[ask]\ntolerance = 1e-" + "9" * 30, "a number with a huge exponent"),
        ("[paking]\n[packing]\nheight = 3\n[ask]\nquantity='profile'", 'mean "packing"'),
        ("folder = 'x'\n", "is unknown"),
    ]:
        with pytest.raises(SceneError, match=says):
            parse_scene(text)


HUGE, LONG = 10**6000, "9" * 5000


@pytest.mark.parametrize(
    ("section", "keys"),
    [
        (fd.Packing, {"height": HUGE}),
        (fd.Packing, {"height": 4, "radius": LONG}),
        (fd.Disorder, {"kind": HUGE}),
        (fd.Disorder, {"kind": "file", "file": LONG}),
        (fd.Load, {"at": [[HUGE] * 50] * 50}),
        (fd.Load, {"kind": LONG}),
        (fd.Effects, {"geometry": [LONG]}),
        (fd.Ask, {"quantity": HUGE}),
        (fd.Ask, {"quantity": {"a": HUGE}}),
        (fd.Ask, {"quantity": [LONG]}),
        (fd.Ask, {"quantity": "profile", "layers": LONG}),
        (fd.Ask, {"quantity": "profile", LONG: 1}),
        (fd.Ask, {"quntity": LONG}),
    ],
)
def test_what_is_huge_is_quoted_in_a_few_words(section: Any, keys: dict[str, Any]) -> None:
    with pytest.raises(SceneError, match=r"must|unknown") as caught:
        section(**keys)
    assert len(str(caught.value)) <= 200


@pytest.mark.parametrize(
    ("section", "key"), [("ask", "quantity"), ("ask", "at"), ("packing", "height")]
)
def test_numbers_of_thousands_of_digits_in_a_file(section: str, key: str) -> None:
    sections = basic(quantity="contact", at=[0, 0, "+"])
    sections[section][key] = "=[0x" + "f" * 4000 + ', 0, "+"]'
    with pytest.raises(SceneError, match=rf"^{section}\.{key} = .*a number of .*: .*must be"):
        scene(sections)


def test_a_slab_has_no_list_of_everything() -> None:
    for quantity in ("contact_forces", "positions", "profile", "histogram"):
        with pytest.raises(SceneError, match=r"packing\.width"):
            scene(basic(4, None, quantity=quantity))


def test_what_float64_cannot_hold_is_answered_in_balls(tmp_path: Path) -> None:
    far = {"radius": "=1e400", "spacing": "=3e400"}
    near = {"radius": "=1e-400", "spacing": "=3e-400"}
    for quantity, packing, std in [
        ("contact_forces", {}, "=1e-301"),
        ("contact_forces", {}, "=1e-3000"),
        ("profile", {}, "=1e-400"),
        ("positions", far, "=1e-4"),
        ("positions", near, "=1e-4"),
    ]:
        sections = basic(3, 8, quantity=quantity)
        sections["packing"].update(packing)
        sections["disorder"]["relative_std"] = std
        for geometry in ("exact", "first-order"):
            sections["effects"] = {"geometry": geometry}
            assert "float64 can't hold" in planned(sections).reason
        outcome = answer(sections)
        assert outcome.accuracy.certified
        assert 0 < outcome.accuracy.error_bound <= 1e-15
        name = {"positions": "dx", "profile": "std"}.get(quantity, "change")
        assert any(row[name] != "0" for row in outcome.decimals())
        json.dumps(outcome.data(), allow_nan=False)
        if quantity == "profile":
            assert all("e-" in row["first_order_std"] for row in outcome.decimals())
    (tmp_path / "loads.csv").write_text("i,j,fx,fy\n1,3,0,-1e-400\n")
    sections = basic(3, 8) | {"load": {"kind": "file", "file": "loads.csv"}}
    assert answer(sections, tmp_path).accuracy.certified


def test_bins_far_below_the_smallest_float() -> None:
    sections = basic(3, 8, quantity="histogram", tolerance="=1e-10", bins=7)
    sections["disorder"]["relative_std"] = "=1e-400"
    rows = answer(sections).decimals()
    assert all(Fraction(row["low"]) < Fraction(row["high"]) for row in rows)
    assert sum(row["count"] for row in rows) == 2 * 3 * 8


def radii_file(folder: Path, text: str) -> dict[str, dict[str, Any]]:
    (folder / "radii.csv").write_bytes(text.encode("utf-8", "surrogateescape"))
    sections = basic(1, 2)
    sections["disorder"] = {"kind": "file", "file": "radii.csv"}
    return sections


GOOD = ["0,0,0.01", "2,0,-0.02", "1,1,1e-3", "3,1,0"]


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        (GOOD[:3], r"bead \(3, 1\) is missing"),
        ([*GOOD, GOOD[0]], r"bead \(0, 0\) is named twice"),
        ([*GOOD[:3], "3,1,-1.0"], r"bead \(3, 1\).*no positive radius"),
        ([*GOOD[:3], "3,1,nan"], r"bead \(3, 1\).*no finite decimal"),
        ([*GOOD[:3], "3,1,inf"], r"bead \(3, 1\).*no finite decimal"),
        ([*GOOD[:3], "3,1,1e9999999999"], r"bead \(3, 1\)"),
        ([*GOOD[:3], "3,1,"], r"bead \(3, 1\)"),
        ([*GOOD[:3], "3,2,0"], r"\(3, 2\).*even"),
        ([*GOOD, "5,1,0"], r"\(5, 1\) lies outside"),
        ([*GOOD[:3], "3,1"], "2 values where 3"),
        ([*GOOD[:3], "x,1,0"], "whole number"),
        ([*GOOD[:3], "0_3,1,0"], "i = '0_3' must be a whole number"),
        ([*GOOD[:3], '"3,1,0'], "CSV"),
        ([*GOOD[:3], "3" * 10**6], "line 5: a line has at most 20000 characters"),
        (["3" * 10**6], "line 2: a line has at most"),
    ],
)
def test_radii_files_name_the_line_and_the_bead(
    tmp_path: Path, lines: list[str], says: str
) -> None:
    sections = radii_file(tmp_path, "\n".join(["i,j,delta_r", *lines, ""]))
    with pytest.raises(TableError, match=says):
        planned(sections, tmp_path)


@given(
    st.lists(st.text(alphabet='0123456789,.-+einfax"\n\r\t \x00\udcff', max_size=30), max_size=8)
)
def test_any_radii_file_gives_an_answer_or_a_message(
    tmp_path_factory: pytest.TempPathFactory, lines: list[str]
) -> None:
    folder = tmp_path_factory.mktemp("fuzz")
    sections = radii_file(folder, "\n".join(["i,j,delta_r", *lines]))
    with pytest.raises(TableError):  # never four good lines by chance: the header's packing has 4
        planned(sections, folder)


def test_endless_files_are_refused_at_once(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (Path("/dev/zero"), pipe, tmp_path):
        with pytest.raises(SceneError, match="regular file"):
            read_scene(path)
        for kind, section in (("disorder", "disorder"), ("load", "load")):
            sections = basic(1, 2)
            sections[section] = {"kind": "file", "file": str(path)}
            with pytest.raises(TableError, match=rf"{kind}\.file.*regular file"):
                planned(sections)
    large = tmp_path / "large"
    for content, says in (
        (b"#" * 16_001, "at most 16000 bytes"),
        (b"a.b = '" + 300 * b".", "is not a scene"),
    ):
        large.write_bytes(content)
        with pytest.raises(SceneError, match=says):
            read_scene(large)


keys = st.sampled_from(
    ["height", "width", "radius", "spacing", "kind", "relative_std", "seed", "file", "at",
     "magnitude", "angle_deg", "geometry", "quantity", "tolerance", "realisations", "bins", "x"]
)  # fmt: skip
values = st.one_of(
    st.sampled_from(
        ["=1e400", "=-0.0", "=nan", "=2.5", "=1e-9", "=1e-4999", "uniform", "file", "point", "+",
         "exact", "profile", "contact", "missing.csv", "", True, 10**18, 10**40, -1, 0, 1, 2, 3]
    ),
    st.lists(st.sampled_from([0, 1, 2, -1, 10**20, "+", "-", "x"]), max_size=4),
    st.text(alphabet=string.ascii_letters, max_size=5),
)  # fmt: skip
changes = st.lists(
    st.tuples(
        st.sampled_from(["packing", "disorder", "load", "effects", "ask", "other"]), keys, values
    ),
    min_size=1,
    max_size=4,
)


# What a run may end with beside an answer; anything else would be a traceback.
REFUSALS = (
    SceneError, TableError, UnbuildableError, NotStandingError, RadiusError, ToleranceError
)  # fmt: skip


def solved_or_refused(sections: dict[str, dict[str, Any]], folder: Path = Path()) -> None:
    """Plan a scene, and run it if it is small; every end but an answer must be a message."""
    message = None
    try:
        made = planned(sections, folder)
        made.data()
        if made.beads < 1500 and getattr(made.system, "bits", 53) <= 2000:
            outcome = run(made)
            json.dumps(outcome.data(), allow_nan=False)
            accuracy = outcome.accuracy
            if not accuracy.certified and 0 < made.problem.radii.relative_std() ** 2 < 1e-300:
                assert accuracy.error_bound > 0  # zero would claim that nothing was rounded away
    except REFUSALS as error:
        message = str(error)
    assert message is None or 10 < len(message) < 600


@given(changes)
def test_any_scene_gives_an_answer_or_a_message(made: list[tuple[str, str, Any]]) -> None:
    sections = basic()
    for section, key, value in made:
        sections.setdefault(section, {})[key] = value
    solved_or_refused(sections)


far = st.sampled_from(
    ["1e-5", "0.3", "1", "3.0", "1e-300", "1e-301", "1e-330", "1e-400", "1e-465", "1e-3000",
     "1e-4999", "1e100", "1e101", "1e150", "1e280", "1e308", "1e400", "1e4999"]
)  # fmt: skip
quantities = st.sampled_from(["contact_forces", "positions", "profile", "histogram", "contact"])


@given(st.data())
def test_numbers_far_outside_of_floats_give_an_answer_or_a_message(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    folder = tmp_path_factory.mktemp("far")
    sections = basic(2, 3, quantity=data.draw(quantities))
    if sections["ask"]["quantity"] == "contact":
        sections["ask"]["at"] = [0, 0, "+"]
    radius = data.draw(far)
    mantissa, _, exponent = radius.partition("e")
    sections["packing"]["radius"] = f"={radius}"
    if data.draw(st.booleans()):
        sections["packing"]["spacing"] = f"={3 * float(mantissa)}e{exponent or 0}"
    kind = data.draw(st.sampled_from(["uniform", "normal", "two-point", "file"]))
    if kind == "file":
        sections["disorder"] = {"kind": "file", "file": "radii.csv"}
        lines = [f"{i},{j},{data.draw(far)}" for j in range(3) for i in range(j % 2, 6, 2)]
        (folder / "radii.csv").write_text("\n".join(["i,j,delta_r", *lines]))
    else:
        sections["disorder"] = {"kind": kind, "relative_std": f"={data.draw(far)}"}
    sections["load"] = {"magnitude": f"={data.draw(far)}"}
    if data.draw(st.booleans()):
        sections["load"] = {"kind": "file", "file": "loads.csv", "magnitude": f"={data.draw(far)}"}
        (folder / "loads.csv").write_text(f"i,j,fx,fy\n0,2,{data.draw(far)},-{data.draw(far)}")
    elif data.draw(st.booleans()):
        sections["load"]["angle_deg"] = data.draw(st.sampled_from([-90, 90, "=89.99"]))
    kinds = st.sampled_from(["exact", "first-order", "ordered"])
    sections["effects"] = {"geometry": data.draw(kinds)}
    if data.draw(st.booleans()):
        sections["ask"]["tolerance"] = f"={data.draw(st.sampled_from(['1e-9', '1e-330']))}"
    solved_or_refused(sections, folder)
