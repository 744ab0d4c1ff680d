"""Several questions in one scene: one packing is solved, and each answer is as if asked alone."""

import json
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric import accuracy
from force_diffusion.numeric.scene.sections import SceneError

import force_diffusion as fd
from tests.numeric.scenes import basic, planned, scene, toml

QUANTITIES = ("contact_forces", "positions", "profile", "histogram", "response")


def asking(*quantities: str, **more: Any) -> dict[str, dict[str, Any]]:
    sections = basic(4, 9, quantity=list(quantities), **more)
    if "response" in quantities:
        sections["load"] = {"kind": "point", "at": [4, 4]}
    return sections


@pytest.mark.parametrize("pair", list(combinations(QUANTITIES, 2)), ids="-".join)
@pytest.mark.parametrize("more", [{}, {"realisations": 3}, {"tolerance": "=1e-25"}])
def test_each_answer_is_as_if_asked_alone(pair, more):
    both = fd.run(planned(asking(*pair, **more)))
    assert tuple(both.results) == pair
    for name, outcome in both.results.items():
        alone = asking(*pair, **more)
        alone["ask"]["quantity"] = name
        assert outcome.decimals() == fd.run(planned(alone)).decimals()


def test_all_are_answered_where_contacts_open():
    sections = basic(5, 7, quantity=["contact_forces", "positions"])
    sections["disorder"]["relative_std"] = "=0.03"
    sections["effects"] = {"contacts": "unilateral"}
    light, heavy = (
        fd.run(scene({**sections, "load": {"magnitude": unit}})).results for unit in (1, 8)
    )
    assert len(light["positions"].rows()) == 6 * 7
    assert min(light["contact_forces"].arrays["force"]) >= 0
    for quantity, name, unit in (("positions", "x", 1), ("contact_forces", "force", 8)):
        a, b = (of[quantity].arrays[name].astype(float) for of in (light, heavy))
        assert a * unit == pytest.approx(b)  # lengths have no unit of force


def test_one_packing_is_solved(monkeypatch):
    solved = []
    true = accuracy.answer

    def counted(*given: Any, **options: Any) -> Any:
        solved.append(len(given[0]))
        return true(*given, **options)

    monkeypatch.setattr(accuracy, "answer", counted)
    fd.run(planned(asking("contact_forces", "positions")))
    assert solved == [2]


def test_files_hold_all_tables(tmp_path, printed):
    path, out = tmp_path / "scene.toml", tmp_path / "out"
    path.write_text(toml(asking("contact_forces", "positions")))
    stdout = printed("run", path, "--out", out, "--format", "npz")
    assert "contact_forces: 72 rows, positions: 45 rows" in stdout
    results = json.loads((out / "result.json").read_text())["results"]
    for name, count in (("contact_forces", 72), ("positions", 45)):
        assert results[name] == {"file": f"{name}.npz", "rows": count}
        assert len(np.load(out / f"{name}.npz")["j"]) == count


def test_other_commands_take_one():
    asked = scene(asking("contact_forces", "positions", realisations=3))
    for refused in (fd.cost, fd.ensemble, lambda question: question.run().plot()):
        with pytest.raises(SceneError, match="must be one quantity"):
            refused(asked)


def test_a_path_is_run(tmp_path, refused):
    path = tmp_path / "scene.toml"
    path.write_text(toml(basic(4, 9)))
    true = fd.run(planned(basic(4, 9))).decimals()
    for what in (path, str(path), fd.read_scene(path)):
        assert fd.run(what).decimals() == true
    assert fd.ensemble(path, 50).realisations == 50
    wrong = {"none.toml": "", "mine.toml": "root:x:0", "xyr.csv": "x,y,r\n0,0,1\n"}
    wrong["long.csv"] = wrong["xyr.csv"] * 9999
    for name, content in wrong.items():
        if content:
            (tmp_path / name).write_text(content)
        message = refused("run", tmp_path / name)
        assert message.count(name) == 1
        assert ("is not a scene, which is a TOML file" if content else "no such file") in message
        assert ('disorder = {kind = "file", file = "radii.csv"}' in message) == ("csv" in name)
