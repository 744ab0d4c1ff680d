"""Plant the faults of ``faults.md`` one by one, in a copy, and run the tests that should see each.

Usage: python tests/faults.py [WORD…]: words of files and names.
"""

import io
import os
import re
import subprocess
import sys
import tarfile
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).parents[1]
ROOMS = "numeric", "symbolic", "derivations", "proofs", "scenes"
_ONE = re.compile(r"^## (\S+): (.*)\n\nSeen by: (.*)\n\n```diff\n-(.*)\n\+(.*)\n```$", re.MULTILINE)


@dataclass(frozen=True)
class Fault:
    """A fault: what stands once in a file, what is put in its place, and tests that should fail."""

    file: str
    name: str
    tests: tuple[str, ...]
    old: str
    new: str


def faults() -> list[Fault]:
    """The faults of ``faults.md``."""
    text = (ROOT / "tests" / "faults.md").read_text(encoding="utf-8")
    return [
        Fault(file, name, tuple(re.findall("`(.*?)`", tests)), old, new)
        for file, name, tests, old, new in _ONE.findall(text)
    ]


def copied(folder: Path) -> None:
    """Copy what is tracked, with what is not committed yet; rooms lie below the package, too."""
    commit = subprocess.check_output(["git", "stash", "create"], cwd=ROOT, text=True).strip()
    archive = subprocess.check_output(["git", "archive", commit or "HEAD"], cwd=ROOT)
    with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        tar.extractall(folder, filter="data")
    for room in ROOMS:
        (folder / "force_diffusion" / room).symlink_to(folder / room)


def tried(folder: Path, fault: Fault) -> str:
    """Say what becomes of a fault: "seen", "survives", or why it can't be tried."""
    path = folder / fault.file
    source = path.read_text(encoding="utf-8") if path.exists() else ""
    if source.count(fault.old) != 1:
        return "no longer applies"
    options = ["-x", "-q", "-n", "0", "-p", "no:cacheprovider"]
    # as by default, of tests that take long a sample
    where = ["-o", f"testpaths={' '.join(fault.tests)}"]
    if any("[" in test for test in fault.tests):  # but for a case that is named
        where = [*fault.tests]
    elif any("::" in test for test in fault.tests):
        where = ["-m", "not long", *fault.tests]
    environment = {
        **os.environ,
        "PYTHONPATH": str(folder),
        "PYTHONDONTWRITEBYTECODE": "1",
        "XDG_CACHE_HOME": str(folder / "cache"),
    }
    path.write_text(source.replace(fault.old, fault.new), encoding="utf-8")
    try:
        status = subprocess.run(
            [sys.executable, "-m", "pytest", *options, *where],
            cwd=folder, env=environment, capture_output=True, check=False, timeout=900,
        ).returncode  # fmt: skip
    except subprocess.TimeoutExpired:
        return "seen, as it takes no end"
    finally:
        path.write_text(source, encoding="utf-8")
    # 1: a test failed; 2: the modules of the tests could not be loaded
    return {0: "SURVIVES", 1: "seen", 2: "seen"}.get(status, f"pytest ended with status {status}")


def main() -> int:
    """Try the faults that are asked for; status 1 where one is not seen."""
    words = sys.argv[1:] or [""]
    wanted = [
        fault for fault in faults() if any(word in f"{fault.file} {fault.name}" for word in words)
    ]
    unseen = 0
    with TemporaryDirectory() as folder:
        copied(Path(folder))
        for fault in wanted:
            fate = tried(Path(folder), fault)
            unseen += not fate.startswith("seen")
            print(f"{fate:10} {fault.file}: {fault.name}", flush=True)
    print(f"{len(wanted) - unseen} of {len(wanted)} are seen")
    return bool(unseen)


if __name__ == "__main__":
    raise SystemExit(main())
