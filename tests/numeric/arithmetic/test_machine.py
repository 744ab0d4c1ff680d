"""Free memory, as Linux reports it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from force_diffusion.numeric.arithmetic.machine import free_of_groups, memory_limit

linux = pytest.mark.skipif(sys.platform != "linux", reason="Linux tells it in files")


def group(folder: Path, limit: str, used: str, allowed: str, now: int, cache: int) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / limit).write_text(f"{allowed}\n")
    (folder / used).write_text(f"{now}\n")
    stat = f"anon {now - cache}\ninactive_file {cache - 1000}\nactive_file 1000\ntotal_rss 5\n"
    (folder / "memory.stat").write_text(stat)


V1 = ("memory.limit_in_bytes", "memory.usage_in_bytes")
V2 = ("memory.max", "memory.current")


def test_every_group_above_this_process_counts(tmp_path):
    own, root = tmp_path / "own", tmp_path / "root"
    own.write_text("0::/batch/job\n")
    group(root / "batch" / "job", *V2, "max", 50_000, 2000)
    group(root / "batch", *V2, "1000000", 300_000, 200_000)
    assert list(free_of_groups(own, root)) == [900_000]
    group(root / "batch" / "job", *V2, "400000", 50_000, 2000)
    assert sorted(free_of_groups(own, root)) == [352_000, 900_000]


def test_the_first_version_of_groups_and_a_container_that_sees_only_its_own(tmp_path):
    own, root = tmp_path / "own", tmp_path / "root"
    own.write_text("4:memory:/docker/0123\n3:cpuset:/\n1:name=systemd:/x:y\n0::/\n")
    group(root / "memory", *V1, "600000", 100_000, 40_000)  # of a name that is not seen here
    assert list(free_of_groups(own, root)) == [540_000]
    assert list(free_of_groups(tmp_path / "none", root)) == []


@linux
def test_files_that_the_system_keeps_are_free():
    meminfo = dict(line.split(":") for line in Path("/proc/meminfo").read_text().splitlines())
    available = 1024 * int(meminfo["MemAvailable"].split()[0])
    assert 0 < memory_limit() <= 0.9 * available  # it is 0.8, and others come and go


@linux
def test_a_limit_of_the_shell_counts():
    program = (
        "from force_diffusion.numeric.arithmetic.machine import memory_limit; print(memory_limit())"
    )
    done = subprocess.run(
        ["bash", "-c", f"ulimit -v 3000000; exec {sys.executable} -c '{program}'"],
        env=os.environ, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert 0 < int(done.stdout) < 0.8 * 3_000_000 * 1024
