"""``--set``: scenes with other values than their files have."""

import csv
import json

from tests.cli.conftest import SCENE


def test_set_gives_the_results_of_a_changed_file(scene, printed):
    words = ("packing.height=4", "disorder.kind=normal", "disorder.seed=7")
    settings = (word for each in words for word in ("--set", each))
    changed_by_words = json.loads(printed("run", scene, *settings, "--json"))
    text = SCENE.replace("height = 3", "height = 4")
    scene.write_text(text.replace("uniform", "normal").replace("seed = 1", "seed = 7"))
    assert changed_by_words["results"] == json.loads(printed("run", scene, "--json"))["results"]


def test_a_sweep_answers_every_combination_in_a_folder_of_its_own(scene, tmp_path, printed):
    out = tmp_path / "out"
    words = ("--set", "packing.height=2,3,4", "--set", "disorder.seed=0,1", "--out", out)
    printed("run", scene, *words, "--set", "load.kind=bulk")
    assert sorted(folder.name for folder in out.iterdir()) == [
        f"packing.height={M},disorder.seed={seed}" for M in (2, 3, 4) for seed in (0, 1)
    ]
    for folder in out.iterdir():
        height = int(folder.name[len("packing.height=")])
        rows = csv.DictReader((folder / "profile.csv").read_text().splitlines())
        assert len(list(rows)) == 2 * height
    stdout = printed("run", scene, "--set", "packing.height=2,3")
    assert "# packing.height = 2\n" in stdout
    assert "# packing.height = 3\n" in stdout


def test_json_of_a_sweep_is_one_list(scene, printed):
    answers = json.loads(printed("run", scene, "--set", "packing.height=2,3", "--json"))
    for height, answer in zip((2, 3), answers, strict=True):
        alone = printed("run", scene, "--set", f"packing.height={height}", "--json")
        assert answer["results"] == json.loads(alone)["results"]
