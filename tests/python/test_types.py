# SPDX-License-Identifier: BSD-3-Clause
import inspect
import os
import pathlib
import subprocess
import sys

import pytest

import psi_slam

pytest.importorskip("mypy")

EXAMPLES = sorted((pathlib.Path(__file__).parents[2] / "share/examples/python").glob("*.py"))


def mypy(*arguments, folder):
    environment = {**os.environ, "MYPYPATH": os.environ["PYTHONPATH"], "MYPY_CACHE_DIR": str(folder)}
    return subprocess.run(
        [sys.executable, "-m", *map(str, arguments)], capture_output=True, text=True, env=environment, cwd=folder,
        check=False,
    )


def test_stubs_describe_the_module(tmp_path):
    # pybind11 has a metaclass of its own, and constructors without a signature.
    allowed = tmp_path / "allowed.txt"
    classes = "|".join(name for name in psi_slam.__all__ if inspect.isclass(getattr(psi_slam, name)))
    module = "psi_slam(\\._core)?"
    allowed.write_text(f"{module}\\.({classes})(\\.__init__)?\n")
    run = mypy("mypy.stubtest", "psi_slam", "--allowlist", allowed, "--concise", folder=tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr


def test_examples_are_typed(tmp_path):
    assert len(EXAMPLES) == 3
    run = mypy("mypy", "--strict", "--ignore-missing-imports", *EXAMPLES, folder=tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr


def test_a_wrong_type_is_found(tmp_path):
    script = tmp_path / "wrong.py"
    script.write_text("import psi_slam\npsi_slam.map('my.log').save(3)\n")
    run = mypy("mypy", script, folder=tmp_path)
    assert run.returncode == 1 and "incompatible type" in run.stdout


def test_everything_public_has_a_doc_string():
    for name in psi_slam.__all__:
        exported = getattr(psi_slam, name)
        if name == "__version__":
            continue
        assert inspect.getdoc(exported), name
        if not inspect.isclass(exported):
            continue
        for member, value in vars(exported).items():
            if not member.startswith("_"):
                assert inspect.getdoc(value), f"{name}.{member}"
