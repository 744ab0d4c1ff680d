"""Coq's answers are read whole; programs in Coq's place that lie, hang, or are another version."""

import hashlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from force_diffusion.derivations.coq import folder
from force_diffusion.derivations.coq.files import theory
from force_diffusion.derivations.coq.folder import CoqAbsentError, CoqFolder, axioms_in

import force_diffusion as fd


def test_assumptions_are_read_whole():
    printed = "Axioms:\nA.b : Prop\nC.d\n  : forall x : nat,\n    x = x\n"
    assert axioms_in(printed) == ("A.b", "C.d")
    assert axioms_in("Closed under the global context\n") == ()
    assert axioms_in("Section Variables:\nx : nat\n") != ()
    assert axioms_in("Axioms:\nf is assumed to be guarded.\n") == ("f",)


def test_without_coq_the_message_says_how_to_install_it(monkeypatch, tmp_path, call):
    monkeypatch.setenv("PATH", "")
    status, stdout, stderr = call("certify", "--out", tmp_path / "out")
    assert (status, stdout) == (CoqAbsentError.exit_status, "")
    assert "apt-get install coq" in stderr
    assert not (tmp_path / "out").exists()


def test_only_the_paper_s_equations_are_stated(call):
    with pytest.raises(ValueError, match=r"Eq\. B5 is not stated for Coq: give a number from 1 to"):
        fd.certify([3, "B5"])
    with pytest.raises(TypeError, match="a list of numbers"):
        fd.certify("13")
    status, _, stderr = call("certify", "B5")
    assert (status, "Eq. B5 is not stated for Coq" in stderr) == (2, True)


VERSION = 'if [ "$1" = --print-version ]; then echo "8.16.1 4.14.1"; exit; fi\n'


@pytest.fixture
def programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that is searched first; programs that take Coq's place are put into it."""
    folder = tmp_path / "programs"
    folder.mkdir()
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}/usr/bin{os.pathsep}/bin")
    put(folder, "coqchk", "exit 1")
    return folder


def put(folder: Path, name: str, script: str) -> None:
    (folder / name).write_text(f"#!/bin/sh\n{script}\n")
    (folder / name).chmod(0o755)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize(
    ("script", "trouble"),
    [
        ("exit 0", "does not say what it rests on"),
        ("echo Closed under the global context", "coqchk: status 1"),
        ("echo 'Error: no' >&2; exit 1", ": no"),
        ("kill -9 $$", "status -9"),
        ('case "$*" in *Model.v) exec sleep 600;; esac', "no answer within"),
    ],
)
def test_a_program_that_checks_nothing_accepts_nothing(programs, script, trouble, monkeypatch):
    if "sleep" in script:
        monkeypatch.setattr(folder, "LIMIT", 2)  # a busy machine says its version within them
    put(programs, "coqc", VERSION + script)
    certification = fd.certify([1])
    assert not certification.passed
    assert trouble in certification.equations[0].note


def test_trouble_with_another_version_names_the_one_that_it_is_written_for(programs):
    put(programs, "coqc", 'case $1 in --print-version) echo "9.1.0 5.2";; *) exit 1;; esac')
    verdict = fd.certify([1]).equations[0]
    assert str(verdict) == "not accepted by Coq 9.1.0"
    assert "written for Coq 8.16.1" in verdict.note


def test_statements_and_verdicts_are_written(programs, tmp_path, call):
    put(programs, "coqc", VERSION + "exit 1")
    out = tmp_path / "out"
    status, stdout, _ = call("certify", 3, 7, "--out", out)
    assert status == 1
    printed = stdout.splitlines()
    lines = [line for line in printed if line.startswith("Eq.")]
    assert lines == [
        f"Eq. {number:>2}  not accepted by Coq 8.16.1  {fd.equation(number).title}"
        for number in (3, 7)
    ]
    assert printed[-1] == "0 of 2 accepted."
    certificate = json.loads((out / "certificate.json").read_text())
    assert [row["accepted"] for row in certificate["equations"]] == [False, False]
    (three, seven) = (row["theorems"] for row in certificate["equations"])
    for name, hashed in (three | seven).items():
        files = (f"{name.capitalize()}{end}.v" for end in ("_statement", "", "_accepted"))
        content = b"".join((out / file).read_bytes() for file in files)
        assert hashlib.sha256(content).hexdigest() == hashed
    assert (out / "Model.v").read_text() == theory()["Model.v"]


@pytest.mark.parametrize("script", ["exit 1", "exit 0", "echo coqc"])
def test_a_program_without_a_version_is_no_coq(programs, tmp_path, script):
    put(programs, "coqc", script)
    with pytest.raises(CoqAbsentError, match="apt-get install coq"):
        CoqFolder(tmp_path)
    with pytest.raises(CoqAbsentError, match="doesn't say its version"):
        fd.certify([1])


@pytest.mark.long
def test_an_interrupt_ends_coq_and_leaves_no_files(programs, tmp_path):
    put(programs, "coqc", VERSION + f'echo $$ >> "{tmp_path}/started"\nexec sleep 600')
    out, scratch = tmp_path / "out", tmp_path / "scratch"
    scratch.mkdir()
    command = [sys.executable, "-m", "force_diffusion", "certify", "1", "--out", str(out)]
    running = subprocess.Popen(
        command, env={**os.environ, "TMPDIR": str(scratch)}, stderr=subprocess.PIPE, text=True
    )
    started = tmp_path / "started"
    while not (started.exists() and started.read_text().endswith("\n")):
        assert running.poll() is None
        time.sleep(0.05)
    running.send_signal(signal.SIGTERM)
    _, err = running.communicate(timeout=600)
    assert running.returncode == 130
    assert "interrupted" in err
    assert "Traceback" not in err
    for process in map(int, started.read_text().split()):
        with pytest.raises(ProcessLookupError):
            os.kill(process, 0)
    assert not out.exists()
    assert not list(scratch.iterdir())
