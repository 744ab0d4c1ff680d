"""What is wrong with a scene or its files is said, with the key, the value and what is allowed."""

import json
import os
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.run.running import read_scene
from force_diffusion.numeric.scene.files import TableError
from force_diffusion.numeric.scene.sections import SceneError

import force_diffusion as fd
from tests.numeric.scenes import answer, basic, listed_loads, parse_scene, planned, question, scene

CONTACT, HISTOGRAM = {"quantity": "contact"}, {"quantity": "histogram"}
SPHERES: dict[str, Any] = {"dimension": 3}
Sections = dict[str, dict[str, Any]]
WRONG: list[tuple[Sections, str]] = [
    ({"packing": {"height": 0}}, "from 1 to 10000000"),
    ({"packing": {"allow_images": "=1.50"}}, "boolean"),
    ({"packing": {"height": "=2.0"}}, "whole number"),
    ({"packing": {"width": 6}}, "allow_images"),
    ({"packing": {"spacing": "=2.0"}}, "strictly between"),
    ({"packing": {"spacing": "=nan"}}, "finite"),
    ({"packing": {"spacing": "three"}}, "must be a number"),
    ({"packing": {"radius": 0}}, "greater than 0"),
    ({"packing": {"hieght": 4}}, 'did you mean "height"'),
    ({"disorder": {"kind": "unifrom"}}, 'did you mean "uniform"'),
    ({"disorder": {"relative_std": "=-1e-3"}}, "at least 0"),
    ({"disorder": {"relative_std": "=0.58"}}, "radius ≤ 0"),
    ({"disorder": {"seed": 2**64}}, "less than"),
    ({"disorder": {"file": "radii.csv"}}, 'needs kind = "file"'),
    ({"load": {"magnitude": 0}}, "greater than 0"),
    ({"load": {"angle_deg": "=90.5"}}, "from -90 to 90"),
    ({"load": {"angle_deg": -180}}, "from -90 to 90"),
    ({"load": {"at": "+"}}, "a bead, [i, j]"),
    ({"effects": {"most_programs": 0}}, "at least 1"),
    ({"effects": {"most_seconds": "=1.50"}}, 'contacts = "unilateral"'),
    ({"ask": {"tolerance": 0}}, "greater than 0"),
    ({"ask": {"realisations": 0}}, "from 1 to 1000000000"),
    ({"ask": {"bins": 5}}, 'needs quantity = "histogram"'),
    ({"ask": {"layers": [0.5]}}, "a list of layers"),
    ({"ask": HISTOGRAM | {"layers": [6]}}, "of lower beads below the load, from 0 to 5"),
    ({"load": {"kind": "point", "at": [0, 4]}, "ask": HISTOGRAM | {"layers": [4]}}, "0 to 3"),
    ({"ask": HISTOGRAM | {"layers": [1, 1]}}, "each once"),
    ({"ask": HISTOGRAM | {"layers": [0], "at": [0, 0, "+"]}}, "asks for one place"),
    ({"ask": {"at": [0, 0, "+"]}}, 'needs quantity = "contact", "histogram" or "positions"'),
    ({"ask": CONTACT | {"at": [0, 0, "x"]}}, "must be a contact"),
    ({"ask": CONTACT | {"at": [0, 1, "+"]}}, "even"),
    ({"ask": CONTACT | {"at": [0, 6, "+"]}}, "j must be from 0 to 5"),
    ({"packing": SPHERES | {"spacing": "=3.3"}}, "must lie strictly"),
    ({"packing": SPHERES, "load": {"kind": "point", "at": [1, 1]}}, "[p, q, j]"),
    ({"packing": SPHERES, "ask": CONTACT | {"at": [1, 1, 6, "1"]}}, "j must be from 0 to 5"),
    ({"packing": SPHERES, "ask": {"quantity": "positions", "at": [1, 1]}}, "must be a bead"),
    ({"ask": {"quantity": []}}, "one quantity, or several, each once"),
    ({"ask": {"quantity": ["profile", "postions"]}}, 'did you mean "positions"'),
    ({"ask": {"quantity": ["histogram", "positions"], "at": [0, 0, "+"]}}, "asks for one place"),
]


@pytest.mark.parametrize(("changes", "says"), WRONG, ids=range(len(WRONG)))
def test_errors_name_the_key_and_what_is_allowed(changes, says):
    sections: Sections = basic()
    for name, keys in changes.items():
        sections[name] = sections.get(name, {}) | keys
    with pytest.raises(SceneError) as caught:
        scene(sections)
    assert f"{name}.{[*keys][-1]}" in str(caught.value)
    assert says in str(caught.value)


def test_columns_of_a_slab_may_be_negative():
    planned(basic(4, None, quantity="contact", at=[-3, 1, "+"]))
    for i in (-(2**60), 2**60):
        with pytest.raises(SceneError, match=r"above -2\^60 and below 2\^60"):
            scene(basic(4, None, quantity="contact", at=[i, 0, "+"]))


def test_missing_sections_and_keys():
    for text, says in [
        ("", r"section \[packing\] is required"),
        ("[packing]\nheight = 3\n", r"section \[ask\] is required"),
        ("[packing]\n[ask]\nquantity = 'contact'\n", "packing.height is required"),
        ("[packing]\nheight = 3\n[disorder]\n[ask]\nquantity = 'contact'\n", "required: uniform, "),
        ("[packing]\nheight = 3\n[ask]\nquantity = ['contact', 'profile']", "ask.at: is required"),
        ("[packing]\nhieght = 3\n[ask]\nquantity = 'profile'", 'hieght: .* mean "height"'),
        ("packing = 3\n", "must be a section"),
        ("[packing\n", "is not a scene, which is a TOML file"),
        ("a = " + "[" * 5000, "nested too deeply"),
        ("[packing]\nheight = 1" + "0" * 6000, "more than 4300 digits"),
        ("[ask]\ntolerance = 1e-" + "9" * 30, "a number with a huge exponent"),
        ("[paking]\n[packing]\nheight = 3\n[ask]\nquantity='profile'", 'mean "packing"'),
    ]:
        with pytest.raises(SceneError, match=says):
            parse_scene(text)


HUGE, LONG = 10**6000, "9" * 5000


@pytest.mark.parametrize(
    ("section", "keys"),
    [
        (fd.Packing, {"height": 4, "radius": LONG}),
        (fd.Load, {"at": [[HUGE] * 50] * 50}),
        (fd.Ask, {"quantity": HUGE}),
        (fd.Ask, {"quantity": "profile", LONG: 1}),
        (fd.Ask, {"quntity": LONG}),
    ],
)
def test_huge_values_are_quoted_briefly(section, keys):
    with pytest.raises(SceneError, match=r"must|unknown") as caught:
        section(**keys)
    assert len(str(caught.value)) <= 200


@pytest.mark.parametrize(
    ("section", "key"), [("ask", "quantity"), ("ask", "at"), ("packing", "height")]
)
def test_numbers_of_thousands_of_digits_in_a_file(section, key):
    sections = basic(quantity="contact", at=[0, 0, "+"])
    sections[section][key] = "=[0x" + "f" * 4000 + ', 0, "+"]'
    with pytest.raises(SceneError, match=rf"^{section}\.{key} = .*a number of .*: .*must be"):
        scene(sections)


def test_what_float64_cannot_hold_is_answered_in_balls(tmp_path):
    for quantity, packing, std in [
        ("contact_forces", {}, "=1e-301"),
        ("profile", {}, "=1e-400"),
        ("positions", {"radius": "=1e400", "spacing": "=3e400"}, "=1e-4"),
        ("positions", {"radius": "=1e-400", "spacing": "=3e-400"}, "=1e-4"),
    ]:
        sections = basic(3, 8, quantity=quantity)
        sections["packing"].update(packing)
        sections["disorder"]["relative_std"] = std
        outcome = answer(sections)
        assert "float64 can't hold" in outcome.plan.reason
        assert outcome.accuracy.certified
        assert 0 < outcome.accuracy.error_bound <= 1e-15
        name = {"positions": "dx", "profile": "std"}.get(quantity, "change")
        assert any(row[name] != "0" for row in outcome.decimals())
        json.dumps(outcome.data(), allow_nan=False)
        if quantity == "profile":
            assert all("e-" in row["first_order_std"] for row in outcome.decimals())
    load = listed_loads(tmp_path, [(1, 3, 0, "-1e-400")])
    assert question("contact_forces", 3, 8, load=load).run().accuracy.certified


def test_bins_far_below_the_smallest_float():
    sections = basic(3, 8, quantity="histogram", tolerance="=1e-10", bins=7)
    sections["disorder"]["relative_std"] = "=1e-400"
    rows = answer(sections).decimals()
    assert all(Fraction(row["low"]) < Fraction(row["high"]) for row in rows)
    assert sum(row["count"] for row in rows) == 2 * 3 * 8


GOOD = ["0,0,0.01", "2,0,-0.02", "1,1,1e-3", "3,1,0"]


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        (GOOD[:3], r"bead \(3, 1\) is missing"),
        ([*GOOD, GOOD[0]], r"bead \(0, 0\) is named twice"),
        ([*GOOD[:3], "3,1,-1.0"], r"bead \(3, 1\).*its radius is 0, and must be greater than 0"),
        ([*GOOD[:3], "3,1,1e9999999999"], r"bead \(3, 1\)"),
        ([*GOOD[:3], "2,1,0"], r"\(2, 1\).*even"),
        ([*GOOD[:3], "3,1"], "2 values where 3"),
        ([*GOOD[:3], "0_3,1,0"], "i = '0_3' must be a whole number"),
        ([*GOOD[:3], '"3,1,0'], "CSV"),
        ([*GOOD[:3], "3" * 10**6], "line 5: a line has at most 20000 characters"),
    ],
)
def test_radii_files_name_the_line_and_the_bead(tmp_path, lines, says):
    (tmp_path / "radii.csv").write_text("\n".join(["i,j,delta_r", *lines, ""]))
    sections = basic(1, 2) | {"disorder": {"kind": "file", "file": "radii.csv"}}
    with pytest.raises(TableError, match=says):
        planned(sections, tmp_path)


def test_endless_files_are_refused_at_once(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (Path("/dev/zero"), pipe, tmp_path):
        with pytest.raises(SceneError, match="regular file"):
            read_scene(path)
        for section in ("disorder", "load"):
            sections = basic(1, 2) | {section: {"kind": "file", "file": str(path)}}
            with pytest.raises(TableError, match=rf"{section}\.file.*regular file"):
                planned(sections)
    large = tmp_path / "large"
    long, deep = "#" * 16_001, "a.b = '" + 300 * "."
    for content, says in ((long, "at most 16000 bytes"), (deep, "is not a scene")):
        large.write_text(content)
        with pytest.raises(SceneError, match=says):
            read_scene(large)
