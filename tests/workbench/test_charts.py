"""Charts: axes, what is drawn where, and that the same chart gives the same bytes everywhere."""

import re
import subprocess
import sys
import xml.etree.ElementTree as tree
from dataclasses import replace

import numpy as np
import pytest
from support.freecad import MOD

sys.path.insert(0, str(MOD))

from beltgrinding.charts import model, svg, ticks  # noqa: E402

from beltgrinding.charts.model import (  # noqa: E402
    Axis, Band, Bars, Chart, Line, Mark, Markers, Panel, Sheet, Text, Tick,
)  # fmt: skip
from beltgrinding.engine import InputError  # noqa: E402
from beltgrinding.reporting import charts  # noqa: E402
from beltgrinding.reporting.language import Language  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"


def example(**changes):
    """A sheet with one of each."""
    square = np.array([[0.0, 2.0], [10.0, 2.0], [10.0, 4.0], [0.0, 4.0]])
    line = np.array([[0.0, 0.0], [5.0, 8.0], [10.0, 8.0]])
    series = [
        Band([square], "#c3d3c3", 0.7, "band", "tolerance"),
        Bars([0.0, 1.0, 2.0], [3.0, 1.0], ["#112233", "#445566"], key="bars"),
        Line([line[:2], line[1:]], "#1f5a96", 2.0, (5, 3), "line", "ground"),
        Markers(line, "#d1701f", shape="diamond", rim="#ffffff", key="markers"),
    ]
    chart = Chart(
        Axis(0.0, 10.0, "time, s"), Axis(0.0, 10.0, "height"), series, [Mark(4.0, "limit")]
    )
    panel = Panel(replace(chart, **changes), 50.0, 40.0, 200.0, 100.0, legend=True)
    return Sheet("example", 300.0, 200.0, [panel], [Text(50, 20, 'a "title" <of> $mine$ & co')])


def elements(text, tag):
    return list(tree.fromstring(text).iter(f"{SVG}{tag}"))


@pytest.mark.parametrize("low, high", [(0.0, 1.0), (-0.05, 0.2), (1e-6, 3e-6), (0.0, 12345.6)])
def test_ticks_are_round_and_inside(low, high):
    found = ticks.ticks(Axis(low, high))
    values, texts = [tick.value for tick in found], [tick.text for tick in found]
    assert 3 <= len(values) <= 9 and values[0] >= low - 1e-12 and values[-1] <= high + 1e-9
    assert [float(text) for text in texts] == pytest.approx(values, abs=1e-12)
    assert len(set(texts)) == len(texts)
    steps = np.diff(values)
    assert steps == pytest.approx(steps[0]) and f"{steps[0]:.0e}"[0] in "125"


def test_ticks_of_a_part_in_another_unit_and_language():
    axis = Axis(0.0, 1.0, size=1e-3, number=Language("de").number)
    found = ticks.ticks(axis, 0.1, 0.102, 4)  # mm, shown in µm
    assert [tick.text for tick in found] == ["100,0", "100,5", "101,0", "101,5", "102,0"]
    assert [tick.value for tick in found] == pytest.approx([0.1, 0.1005, 0.101, 0.1015, 0.102])
    assert [tick.text for tick in ticks.ticks(replace(axis, labelled=False))] == [""] * 6
    own = (Tick(0.5, "half"), Tick(2.0, "beyond"))
    assert ticks.ticks(replace(axis, ticks=own)) == [own[0]]
    told = [tick.text for tick in ticks.ticks(Axis(-0.04, 0.04, count=2))]
    assert told == ["-0.04", "-0.02", "0.00", "0.02", "0.04"]  # never one alone
    assert ticks.ticks(Axis(3.0, 3.0)) and ticks.ticks(Axis(0.0, 1e-12))


def test_a_logarithmic_axis_has_the_ticks_of_its_decades():
    found = ticks.ticks(Axis(0.3, 70.0, scale=model.LOGARITHMIC))
    assert [tick.text for tick in found] == ["0.5", "1", "2", "5", "10", "20", "50"]


def test_one_scale_widens_what_has_room():
    chart = Chart(Axis(0.0, 10.0), Axis(0.0, 1.0), equal=True)
    assert model.window(chart, 200.0, 100.0) == pytest.approx((0.0, -2.0, 10.0, 3.0))
    assert model.window(chart, 100.0, 200.0, (0, 0, 1, 1)) == pytest.approx((0, -0.5, 1, 1.5))
    assert model.window(replace(chart, equal=False), 200.0, 100.0) == (0.0, 0.0, 10.0, 1.0)


def test_series_are_drawn_where_they_are():
    text = svg.svg(example())
    groups = {g.get("class"): g for g in elements(text, "g") if g.get("class")}

    def points(key):
        (path,) = groups[key].iter(f"{SVG}path")
        return np.array(re.findall(r"-?[\d.]+", path.get("d")), dtype=float).reshape(-1, 2), path

    line, path = points("line")
    np.testing.assert_allclose(line, [[50, 140], [150, 60], [150, 60], [250, 60]])
    assert path.get("stroke") == "#1f5a96" and path.get("stroke-width") == "2"
    assert [float(v) for v in path.get("stroke-dasharray").split(",")] == [5.0, 3.0]
    band, path = points("band")
    assert band.min(axis=0).tolist() == [50, 100] and band.max(axis=0).tolist() == [250, 120]
    assert path.get("fill") == "#c3d3c3" and "0.7" in (
        path.get("opacity"),
        path.get("fill-opacity"),
    )
    uses = list(groups["markers"].iter(f"{SVG}use"))
    assert [(float(u.get("x")), float(u.get("y"))) for u in uses] == [
        (50, 140),
        (150, 60),
        (250, 60),
    ]
    fills = {path.get("fill") for path in elements(text, "path")}
    assert {"#112233", "#445566"} <= fills


def test_texts_are_texts_in_the_pages_font():
    found = elements(svg.svg(example()), "text")
    told = {"".join(one.itertext()) for one in found}
    assert {
        'a "title" <of> $mine$ & co',
        "time, s",
        "height",
        "limit",
        "tolerance",
        "ground",
    } <= told
    assert {"0", "2", "10"} <= told
    assert not any(one.get("font-family") or one.get("style") for one in found)


def test_the_same_chart_gives_the_same_bytes():
    import matplotlib

    first = {kind: svg.picture(example(), kind) for kind in ("svg", "png", "pdf")}
    assert first["png"].startswith(b"\x89PNG") and first["pdf"].startswith(b"%PDF")
    assert not re.search(rb"20\d\d-\d\d|[Mm]atplotlib", first["svg"])
    # What the user has told matplotlib changes nothing, and is left as it is.
    own = {"lines.linewidth": 9.0, "font.size": 30.0, "svg.fonttype": "path", "axes.grid": True}
    with matplotlib.rc_context(own):
        again = {kind: svg.picture(example(), kind) for kind in first}
        assert {name: matplotlib.rcParams[name] for name in own} == own
    assert again == first


def test_it_can_stand_in_a_page_next_to_others():
    one, other = example(), replace(example(), name="other")
    texts = [svg.svg(sheet, "chart", "What it shows", standalone=False) for sheet in (one, other)]
    for text in texts:
        root = tree.fromstring(text)
        assert root.get("class") == "chart" and root.get("aria-label") == "What it shows"
        assert root.get("viewBox") == "0 0 300 200" and root.get("width") is None
        assert "<style" not in text and " style=" not in text and "<!DOCTYPE" not in text
        named = set(re.findall(r' id="([^"]+)"', text))
        assert named == set(re.findall(r'(?:url\(|href=")#([^")]+)', text))
    ids = [set(re.findall(r' id="([^"]+)"', text)) for text in texts]
    assert ids[0] and ids[0].isdisjoint(ids[1])


def test_what_is_empty_is_drawn_empty():
    nothing = [Line([], "#000000", key="line", label="line"), Band([], "#000000"),
      Markers(np.zeros((0, 2)), "#000000"), Bars([0.0, 1.0], [0.0], ["#000000"])]  # fmt: skip
    assert "nan" not in svg.svg(example(series=nothing))
    assert elements(svg.svg(example(series=[], marks=[])), "text")


def test_matplotlib_waits_and_may_be_missing(monkeypatch):
    code = (
        "import sys; sys.path.insert(0, sys.argv[1]);"
        "from beltgrinding.charts import model, svg, ticks;"
        "import beltgrinding.reporting.charts, beltgrinding.inspection.section_plot;"
        "assert not any(name.startswith('matplotlib') for name in sys.modules);"
        "sheet = model.Sheet('s', 9.0, 9.0, []); assert svg.svg(sheet);"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code, str(MOD)], check=True)
    ticks.library.cache_clear()
    for name in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    for asked in (lambda: svg.svg(example()), lambda: ticks.ticker()):
        with pytest.raises(InputError, match="python3-matplotlib"):
            asked()
    ticks.library.cache_clear()


@pytest.mark.parametrize("code, number", [("en", "0.2"), ("de", "0,2")])
def test_the_charts_of_a_report_speak_its_language(code, number):
    bins = {"time": [0.25, 0.75], "force": [0.0, 1.0]}
    bins.update(peak_pressure=[0.0, 0.0], removal_rate=[1.0, 1e6])
    words = Language(code)
    told = {text.text for text in elements(charts.series(bins, words), "text")}
    assert {number, words("time, s"), f"{words('Peak pressure')}, MPa"} <= told, told
    numbers = [text for text in told if text.replace(".", "").replace(",", "").isdigit()]
    assert max(map(len, numbers)) == len("1000000")  # of nothing but zeros, too
    told = {
        "".join(t.itertext()) for t in elements(charts.legend((-0.05, 0.05, 0.3), words), "text")
    }
    assert f"≥ {words.number(0.3, 3, True)} mm" in told and words("cut too deep") in told
    assert charts.series(None, words) is None and charts.series({"time": []}, words) is None
