"""A program as a table and in figures, from the command line."""

import csv
import json

import pytest

from beltgrinding import cli

KRL = """DEF p()
$BASE = {X 0,Y 0,Z 0,A 0,B 0,C 0}
$VEL.CP = 0.05
PTP {A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}
LIN {X 10,Y 0,Z 5,A 0,B 90,C 0}
CIRC {X 20,Y 10,Z 5},{X 30,Y 0,Z 5,A 0,B 90,C 0}
END
"""


def test_every_programmed_pose_is_a_row(tmp_path, capsys):
    (tmp_path / "p.src").write_text(KRL)
    output = tmp_path / "poses.csv"
    assert cli.main(["program", str(tmp_path / "p.src"), "-o", str(output)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["language"] and found["motions"] == 4 and found["poses"] == 3
    assert found["extents_mm"]["x"] == [10, 30] and found["problems"] == 0
    rows = list(csv.DictReader(output.open()))
    assert [row["motion"] for row in rows] == ["PTP", "LIN", "CIRC-AUX", "CIRC"]
    assert [row["line"] for row in rows] == ["4", "5", "6", "6"]
    assert rows[0]["x_mm"] == "" and rows[0]["qw"] == ""
    assert float(rows[1]["speed_mm_s"]) == 50
    assert float(rows[3]["x_mm"]) == pytest.approx(30)
    assert sum(float(rows[3][q]) ** 2 for q in ("qw", "qx", "qy", "qz")) == pytest.approx(1)


def test_what_cannot_be_read_is_named(tmp_path, capsys):
    assert cli.main(["program", str(tmp_path / "absent.src")]) == 2
    assert "absent.src" in capsys.readouterr().err
    (tmp_path / "p.xyz").write_text("")
    assert cli.main(["program", str(tmp_path / "p.xyz")]) == 2
    assert "known" in capsys.readouterr().err
