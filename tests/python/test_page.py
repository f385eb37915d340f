# SPDX-License-Identifier: BSD-3-Clause
import pathlib
import re
import shutil

import psi_slam

PAGE = pathlib.Path(__file__).parents[2] / "share/doc/python.md"


def test_blocks_of_the_page_run(log, tmp_path, monkeypatch):
    """Runs the python blocks of the page in their order. The evaluation needs relations and a result of my.log."""
    shutil.copy(log, tmp_path / "my.log")
    (tmp_path / "my.relations").write_text("1000 1005 1.9 0.5 0 0 0 0.5\n")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.M | re.S)
    assert len(blocks) == 4
    names = {}
    exec(blocks[0], names)  # pylint: disable=exec-used
    exec(blocks[2], names)
    exec(blocks[3], names)
    assert len(names["result"].poses) == 320
    assert (tmp_path / "out" / "map.yaml").exists()
    assert names["evaluation"].used == 1
    exec(blocks[1], names)
    assert len(names["result"].poses) == 5


def test_the_page_names_all_fields_of_poses(result):
    page = PAGE.read_text()
    assert [name for name in result.poses.dtype.names if f"`{name}`" not in page] == []
    assert [name for name in psi_slam.__all__ if isinstance(getattr(psi_slam, name), type)
            and issubclass(getattr(psi_slam, name), BaseException) and f"psi_slam.{name}" not in page] == []
