"""The memory that a plan predicts holds for every question: measured in processes of their own."""

import json
import subprocess
import sys
import tracemalloc

import pytest
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.scene.sections import SceneError

from tests.numeric.scenes import basic, planned, scene

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the peak is in bytes of Linux")

# Answers of so many rows that they, and not the libraries, take the memory.
DRAWN = 'disorder = {kind = "uniform", relative_std = 1e-9}\n'
POINT = 'packing = {height = 260}\nload = {kind = "point", at = [0, 260]}\n'
SCENES = {
    "contact forces": 'packing = {height = 100, width = 350}\nask = {quantity = "contact_forces"}',
    "positions": 'packing = {height = 200, width = 350}\nask = {quantity = "positions"}',
    "responses": POINT + 'ask = {quantity = "response", realisations = 80}',
    "contact": "packing = {height = 5}\n"
    'ask = {quantity = "contact", at = [0, 0, "+"], realisations = 50_000}',
    "histogram": "packing = {height = 10, width = 40}\n"
    'ask = {quantity = "histogram", bins = 100_000, realisations = 50}',
    "profile": 'packing = {height = 300, width = 1000}\nask = {quantity = "profile"}',
    "balls": 'packing = {height = 40, width = 90}\nask = {quantity = "contact_forces", '
    "tolerance = 1e-30}",
}
MUCH = 1.6  # NumPy, for which a plan has room, takes more than compiled loops
PROGRAM = """
import sys
from force_diffusion.__main__ import main
assert main(["run", sys.argv[1], "--json"]) == 0
(peak,) = (line for line in open("/proc/self/status") if line.startswith("VmHWM:"))
print(1024 * int(peak.split()[1]), file=sys.stderr)
"""


@pytest.mark.long(share=2)
@pytest.mark.parametrize("name", SCENES)
def test_no_run_takes_more_than_its_plan_says_nor_much_less(name, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text(f"{DRAWN}{SCENES[name]}\n")
    predicted, peaks = 0, []
    for _ in range(3):  # the system may take back pages meanwhile, and then the peak is too low
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM, str(scene)], capture_output=True, text=True, check=True
        )
        predicted = json.loads(done.stdout)["plan"]["memory_bytes"]
        peaks.append(int(done.stderr))
        if predicted <= MUCH * peaks[-1]:
            break
    assert max(peaks) <= predicted <= MUCH * max(peaks)


@pytest.mark.parametrize(
    ("sizes", "key"),
    [
        ({"height": 3, "width": 10**12}, "packing.width = 1000000000000"),
        ({"height": 9_999_999, "width": 10**5}, "packing.height = 9999999"),
        ({"height": 5, "width": 12, "realisations": 10**9}, "ask.realisations = 1000000000"),
    ],
)
def test_what_is_too_large_is_named(sizes, key):
    many = sizes.pop("realisations", 1)
    sections = basic(**sizes, quantity="contact_forces", realisations=many)
    sections["packing"]["allow_images"] = True
    with pytest.raises(SceneError, match=f"{key}: this scene would need about .* of memory"):
        planned(sections)


@pytest.mark.parametrize("load", [{}, {"load": {"kind": "point", "at": [0, 10_000_000]}}])
def test_too_high_a_slab_is_refused_before_its_layers_are_listed(load):
    sections = basic(10_000_000, None, quantity="contact", at=[0, 0, "+"]) | load
    tracemalloc.start()
    with pytest.raises(SceneError, match="of memory"):
        planned(sections)
    assert tracemalloc.get_traced_memory()[1] < 10_000_000  # bytes, one for each layer
    tracemalloc.stop()


def test_no_more_memory_is_used_than_may_be(monkeypatch):
    monkeypatch.setattr("force_diffusion.numeric.planning.planner.memory_limit", lambda: 10**8)
    with pytest.raises(SceneError, match=r"of memory.*100 MB may be used"):
        plan(scene(basic(100, 201)))
