"""Studies: the runs of each design against theory, what varies put into a job, and what is refused."""

import copy

import numpy as np
import pytest
from scipy import stats

from beltgrinding.engine import InputError, core
from beltgrinding.job import load as jobs
from beltgrinding.simulation import run as runs
from beltgrinding.studies import batch, design as designs, making, vary
from beltgrinding.studies.keys import Key
from support import pictures
from test_job import plate_job


@pytest.fixture(scope="module")
def job():
    return jobs.validate(plate_job())


def study_of(entries, method="monte_carlo", runs=100, **more):
    return making.validate(
        {
            "job": plate_job(),
            "vary": entries,
            "design": {"method": method, "runs": runs, **more.pop("design", {})},
            **more,
        }
    )


def rows(entries, *arguments, **options):
    study = study_of(entries, *arguments, **options)
    return designs.design(study, vary.variables(study)).rows


def force(**given):
    return {"name": "force", "key": "belt_machine.force_N", **given}


def law(kind, **given):
    return force(distribution={"kind": kind, **given})


KINDS = [
    (law("normal", mean=40, sd=3), stats.norm(40, 3)),
    (law("uniform", lower=20, upper=60), stats.uniform(20, 40)),
    (force(range=[20, 60]), stats.uniform(20, 40)),
    (law("triangular", lower=20, mode=30, upper=60), stats.triang(0.25, 20, 40)),
    (law("weibull", scale=40, shape=2.5), stats.weibull_min(2.5, scale=40)),
    (
        law("lognormal", mean=40, sd=10),
        stats.lognorm(np.sqrt(np.log(1 + 1 / 16)), scale=40 / np.sqrt(1 + 1 / 16)),
    ),
    (law("normal", mean=40, sd=3, lower=38, upper=41), stats.truncnorm(-2 / 3, 1 / 3, 40, 3)),
    (law("normal", mean=40, sd=3, lower=40), stats.truncnorm(0, np.inf, 40, 3)),
    (law("normal", mean=40, sd=3, upper=40), stats.truncnorm(-np.inf, 0, 40, 3)),
]


@pytest.mark.slow
@pytest.mark.parametrize("method", ["monte_carlo", "latin_hypercube", "sobol", "sobol_indices"])
@pytest.mark.parametrize("entry, wanted", KINDS)
def test_what_is_drawn_is_distributed_as_asked(method, entry, wanted):
    drawn = np.array(rows([entry], method, 512))[:, 0]
    assert stats.kstest(drawn, wanted.cdf).pvalue > 1e-3
    error = wanted.std() / np.sqrt(len(drawn))
    assert abs(drawn.mean() - wanted.mean()) < 4 * error
    assert abs(drawn.std() / wanted.std() - 1) < 0.15


@pytest.mark.parametrize("method", ["monte_carlo", "latin_hypercube", "sobol"])
def test_correlations_are_those_asked_for(method):
    entries = [
        law("normal", mean=40, sd=3),
        {
            "name": "k",
            "key": "law.coefficient_mm2_per_N",
            "distribution": {"kind": "normal", "mean": 1e-4, "sd": 1e-5},
        },
        {"name": "free", "key": "stock.allowance_mm", "range": [0.1, 0.3]},
    ]
    given = [{"between": ["k", "force"], "coefficient": -0.7}]
    drawn = np.array(rows(entries, method, 2000, correlations=given))
    found = np.corrcoef(drawn.T)  # of normal variables the copula's own
    assert found[0, 1] == pytest.approx(-0.7, abs=0.04)
    assert abs(found[0, 2]) < 0.06 and abs(found[1, 2]) < 0.06
    assert stats.kstest(drawn[:, 2], stats.uniform(0.1, 0.2).cdf).pvalue > 1e-3


@pytest.mark.parametrize("correlations", [[], [{"between": ["force", "z"], "coefficient": 0.8}]])
def test_a_latin_hypercube_hits_each_stratum_once(correlations):
    entries = [force(range=[0, 50]), {"name": "z", "key": "placement.z_mm", "range": [0, 50]}]
    drawn = np.array(rows(entries, "latin_hypercube", 50, correlations=correlations))
    for column in drawn.T:
        assert sorted(np.floor(column).astype(int)) == list(range(50))


def test_a_sobol_sequence_fills_more_evenly_than_chance():
    entries = [force(range=[0, 1]), {"key": "stock.allowance_mm", "range": [0, 1]}]
    sobol, chance = (
        stats.qmc.discrepancy(np.array(rows(entries, method, 256)))
        for method in ("sobol", "monte_carlo")
    )
    assert sobol < chance / 5


def test_a_grid_has_every_value_with_every_other():
    entries = [
        force(range=[20, 60], steps=3),
        {"name": "model", "key": "law.model", "values": ["local_linear", "local"]},
        {
            "key": "stock.allowance_mm",
            "distribution": {"kind": "uniform", "lower": 0, "upper": 1},
            "steps": 2,
        },
    ]
    found = rows(entries, "grid")
    assert len(found) == len(set(found)) == 12
    assert {row[0] for row in found} == {20, 40, 60}
    assert {round(row[2], 9) for row in found} == {0.25, 0.75}
    assert [row[1] for row in found[:4]] == ["local_linear"] * 2 + ["local"] * 2


@pytest.mark.slow
def test_the_same_seed_gives_the_same_runs_and_another_others():
    entries = [law("normal", mean=40, sd=3), {"key": "stock.allowance_mm", "range": [0, 1]}]
    for method in ("monte_carlo", "latin_hypercube", "sobol_indices"):
        one, again, other = (rows(entries, method, 16, design={"seed": seed}) for seed in (3, 3, 4))
        assert one == again and one != other


@pytest.mark.parametrize("second_order, count", [(False, 5), (True, 8)])
def test_blocks_of_sobol_indices_are_those_that_openturns_evaluates(second_order, count):
    ot = designs.openturns()
    entries = [
        {"name": name, "key": f"placement.{name}_mm", "range": [-np.pi, np.pi]} for name in "xyz"
    ]
    size = 4096
    study = study_of(entries, "sobol_indices", size, design={"second_order": second_order})
    made = designs.design(study, vary.variables(study))
    assert len(made.rows) == count * size and made.size == size
    x = np.array(made.rows)
    # Ishigami's function, a = 7, b = 0.1 (Ishigami and Homma 1990), whose indices are known.
    y = np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    found = ot.SaltelliSensitivityAlgorithm(ot.Sample(x), ot.Sample(y[:, None]), made.size)
    first, total = found.getFirstOrderIndices(), found.getTotalOrderIndices()
    assert list(first) == pytest.approx([0.314, 0.442, 0.0], abs=0.06)
    assert list(total) == pytest.approx([0.558, 0.442, 0.244], abs=0.06)


def test_values_come_as_often_as_their_weights():
    entry = {"key": "law.model", "values": ["local", "local_linear"], "weights": [3, 1]}
    found = [row[0] for row in rows([entry], "latin_hypercube", 400)]
    assert found.count("local") == 300 and found.count("local_linear") == 100


@pytest.mark.slow
@pytest.mark.parametrize(
    "entries, options, code, told",
    [
        ([force(range=[60, 20])], {}, "studies.ends_swapped", "vary[0].range"),
        ([force(range=[20, 60])], {"method": "grid"}, "studies.no_steps", "vary[0]"),
        ([law("normal", mean=40)], {}, "studies.distribution_lacks", "'sd'"),
        ([law("normal", mean=40, sd=1, mode=2)], {}, "studies.needless_key", "'mode'"),
        (
            [law("normal", mean=0, sd=1, lower=50)],
            {},
            "studies.cut_off_all",
            "vary[0].distribution",
        ),
        ([law("lognormal", mean=-1, sd=1)], {}, "studies.lognormal_mean", "mean"),
        ([law("triangular", lower=0, mode=9, upper=5)], {}, "studies.mode_outside", "mode"),
        ([force(values=[1, 2], weights=[1])], {}, "studies.weights", "1 weights for 2"),
        ([force(range=[20, 60], weights=[1])], {}, "studies.needless_key", "weights"),
        (
            [force(range=[1, 2])],
            {"correlations": [{"between": ["force", "forge"], "coefficient": 0.1}]},
            "studies.correlated_unknown",
            "did you mean 'force'?",
        ),
        (
            [force(range=[1, 2])],
            {"correlations": [{"between": ["force", "force"], "coefficient": 0.1}]},
            "studies.correlated_twice",
            "correlations[0]",
        ),
        (
            [force(values=[1, 2])],
            {
                "method": "grid",
                "correlations": [{"between": ["force", "force"], "coefficient": 0.1}],
            },
            "studies.correlated_twice",
            "correlations[0]",
        ),
    ],
)
def test_what_makes_no_design_is_refused(entries, options, code, told):
    with pytest.raises(InputError) as error:
        rows(entries, **options)
    assert error.value.code == code and told in str(error.value)


def test_correlations_that_cannot_be_and_designs_that_have_none_are_refused():
    entries = [{"name": n, "key": f"placement.{n}_mm", "range": [0, 1]} for n in "xyz"]
    impossible = [{"between": list(pair), "coefficient": -0.9} for pair in ("xy", "yz", "xz")]
    with pytest.raises(InputError, match="positive definite"):
        rows(entries, correlations=impossible)
    with pytest.raises(InputError, match="independent"):
        rows(entries, "sobol_indices", correlations=impossible[:1])
    many = [
        {"name": str(k), "key": "belt_machine.force_N", "how": "add", "range": [0, 1]}
        for k in range(1200)
    ]
    with pytest.raises(InputError, match="OpenTURNS makes no such design of 1200"):
        rows(many, "sobol")
    wide = [{**one, "range": [0, 1], "steps": 100} for one in many[:4]]
    with pytest.raises(InputError, match="more than 1000000"):
        rows(wide, "grid")


@pytest.mark.slow
def test_the_manuals_picture_of_the_designs():
    import io

    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    entries = [
        force(range=[20, 60], steps=8),
        {"name": "allowance", "key": "stock.allowance_mm", "range": [0.1, 0.3], "steps": 8},
    ]
    given = [{"between": ["force", "allowance"], "coefficient": 0.8}]
    kinds = [
        ("grid, 8 x 8", "grid", []),
        ("monte_carlo", "monte_carlo", []),
        ("latin_hypercube", "latin_hypercube", []),
        ("sobol", "sobol", []),
        ("latin_hypercube, correlation 0.8", "latin_hypercube", given),
    ]
    figure, axes = pyplot.subplots(1, 5, figsize=(15, 3.4), sharey=True, layout="constrained")
    for ax, (title, method, correlated) in zip(axes, kinds):
        drawn = np.array(rows(entries, method, 64, correlations=correlated))
        assert drawn.shape == (64, 2)
        ax.scatter(*drawn.T, s=14, color="#1f5fa8")
        ax.set(title=title, xlim=(18, 62), ylim=(0.09, 0.31), xlabel="force_N, N")
    axes[0].set_ylabel("allowance_mm, mm")
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=100)
    pyplot.close(figure)
    pictures.keep("study-designs", file.getvalue())
    pictures.check(pictures.RELEASE, ["study-designs"])


# Keys ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, code, told",
    [
        ("belt_machine.forceN", "studies.unknown_key", "did you mean 'force_N'?"),
        ("belt_machine.force_N.x", "studies.key_leads_nowhere", "has no keys"),
        ("belt_machine[0]", "studies.key_leads_nowhere", "is no list"),
        ("programs.feed_mm_s", "studies.key_leads_nowhere", "has no keys"),
        ("programs[-1].feed_mm_s", "studies.no_key", "programs[0].feed_mm_s"),
        ("", "studies.no_key", ""),
    ],
)
def test_what_is_no_key_of_a_job_is_refused(text, code, told):
    with pytest.raises(InputError) as error:
        Key(text, "vary[3].key")
    assert (
        error.value.code == code and told in str(error.value) and "vary[3].key" in str(error.value)
    )


def test_a_value_is_put_into_a_copy_that_shares_what_does_not_vary(job):
    before = copy.deepcopy(job)
    made = Key("belt_machine.force_N").changed(job, 44.0)
    assert made["belt_machine"]["force_N"] == 44.0 and job == before
    assert (
        made["programs"] is job["programs"]
        and made["belt_machine"]["wheel"] is job["belt_machine"]["wheel"]
    )
    assert (
        Key("belt_machine.force_N").changed(job, 2.0, "multiply")["belt_machine"]["force_N"] == 60.0
    )
    assert Key("stock.allowance_mm").changed(job, -0.05, "add")["stock"][
        "allowance_mm"
    ] == pytest.approx(0.15)
    slow = Key("programs[*].poses[*].feed_mm_s").changed(job, 0.5, "multiply")
    assert [pose["feed_mm_s"] for pose in slow["programs"][0]["poses"]] == [15.0, 15.0]
    first = Key("programs[0].poses[1].feed_mm_s").changed(job, 7.0)
    assert [pose["feed_mm_s"] for pose in first["programs"][0]["poses"]] == [30, 7.0]
    missing = Key("programs[0].feed_mm_s").changed(job, 25.0)
    assert missing["programs"][0]["feed_mm_s"] == 25.0 and "feed_mm_s" not in job["programs"][0]
    framed = Key("cell.base_from_work.position_mm[2]").changed(job, 3.0)
    assert framed["cell"]["base_from_work"] == {"position_mm": [0, 0, 3.0]} and job == before


@pytest.mark.parametrize(
    "text, value, how, code",
    [
        ("belt_machine.force_N", -1.0, "set", "base.below_minimum"),
        ("belt_machine.force_N", "much", "set", "base.wrong_type"),
        ("law.model", "loca", "set", "base.not_one_of"),
        ("programs[0].feed_mm_s", 1.0, "add", "studies.nothing_to_change"),
        ("law.model", 1.0, "add", "studies.nothing_to_change"),
        ("programs[4].feed_mm_s", 1.0, "set", "studies.no_such_item"),
        ("cell.bodies[*].unit_mm", 1.0, "set", "studies.no_such_item"),
    ],
)
def test_a_value_that_a_job_cannot_have_is_refused(job, text, value, how, code):
    with pytest.raises(InputError) as error:
        Key(text).changed(job, value, how)
    assert error.value.code == code and text.split("[")[0].split(".")[0] in str(error.value)


def test_a_run_whose_value_the_schema_forbids_is_named_before_anything_runs():
    study = study_of([law("normal", mean=1, sd=10)], runs=50)
    with pytest.raises(
        InputError, match=r"run \d+: belt_machine.force_N: -\d.* less than the minimum"
    ):
        making.prepare(study)


@pytest.mark.parametrize(
    "entries, code",
    [
        ([force(range=[1, 2]), {**force(range=[1, 2]), "name": "other"}], "studies.set_twice"),
        ([force(range=[1, 2]), {**force(range=[1, 2]), "how": "add"}], "studies.name_taken"),
        ([{**force(range=[1, 2]), "name": "status"}], "studies.name_taken"),
        ([{**force(range=[1, 2]), "name": "a\nb"}], "studies.bad_name"),
        ([force(parts=[{"scan": "a.ply"}])], "studies.parts_and_key"),
        ([{"key": "part", "values": [1]}], "studies.parts_and_key"),
        ([{"key": "placement.q_mm", "range": [0, 1]}], "studies.no_such_error"),
        ([{"key": "placement.x_mm", "range": [0, 1], "how": "add"}], "studies.only_set"),
        ([{"key": "placement.x_mm", "values": ["a"]}], "studies.no_number"),
        ([force(values=["a"], how="add")], "studies.no_number"),
    ],
)
def test_variables_that_contradict_each_other_are_refused(entries, code):
    with pytest.raises(InputError) as error:
        vary.variables(study_of(entries))
    assert error.value.code == code


# Errors of place ---------------------------------------------------------------------------------------


def test_an_error_of_place_turns_about_its_point():
    matrix = vary.transform({"rz_deg": 90.0, "x_mm": 1.0}, [10.0, 0.0, 0.0])
    assert matrix @ [10, 0, 0, 1] == pytest.approx([11, 0, 0, 1])
    assert matrix @ [12, 0, 0, 1] == pytest.approx([11, 2, 0, 1])
    assert np.array_equal(vary.transform({}, [3.0, 4.0, 5.0]), np.eye(4))


@pytest.mark.parametrize("holding", ["tool_in_hand", "part_in_hand"])
def test_the_part_lies_off_in_its_own_axes_or_its_holders(job, holding):
    name = vary.OF_HOLDING[holding]
    turned = {"position_mm": [100.0, 0.0, 0.0], "abc_deg": [90.0, 0.0, 0.0]}
    cell = {**job["cell"], "holding": holding, name: turned}
    placed = {**job, "cell": cell}
    found = vary.variables(study_of([{"key": "placement.x_mm", "range": [0, 1]}]))
    for frame, wanted in (("part", [100.0, 0.5, 0.0]), ("holder", [100.5, 0.0, 0.0])):
        made = vary.job_of(placed, found, [0.5], {"frame": frame, "about_mm": [0, 0, 0]})
        assert made["cell"][name]["position_mm"] == pytest.approx(wanted)
    same = vary.job_of(placed, found, [0.0], {"frame": "part", "about_mm": [0, 0, 0]})
    assert same["cell"] is cell


def heights(job):
    """Stock of a job before it is ground, mm."""
    from beltgrinding.job import workpiece

    warnings, context = [], core.RunContext()
    shape = workpiece.read_design(job["design"], context)
    field = workpiece.make_field(job, shape, warnings, context)
    workpiece.apply_stock(field, job["stock"], warnings, context)
    return field


def stocked(job, kind, tmp_path):
    """The job with a layer of 0.2 mm on its plate, told in three ways."""
    if kind == "allowance":
        return job
    corners = np.array([[-9, -9, 0.2], [69, -9, 0.2], [69, 49, 0.2], [-9, 49, 0.2]], np.float32)
    mesh = core.TriangleMesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
    stock = {"kind": "solid", "brep": core.shape_from_mesh(mesh).write_brep()}
    if kind == "mesh":
        stock = {"kind": "mesh", "file": str(tmp_path / "scan.off")}
        points = "\n".join(" ".join(map(str, point)) for point in corners.tolist())
        (tmp_path / "scan.off").write_text(f"OFF\n4 2 0\n{points}\n3 0 1 2\n3 0 2 3\n")
    return jobs.validate({**plate_job(), "stock": stock})


@pytest.mark.parametrize("kind", ["allowance", "solid", "mesh"])
def test_stock_that_is_thicker_or_lies_off(job, kind, tmp_path):
    given = stocked(job, kind, tmp_path)
    found = vary.variables(
        study_of(
            [
                {"key": "stock.offset_mm", "range": [0, 1]},
                {"key": "stock_placement.z_mm", "range": [0, 1]},
                {"key": "stock_placement.ry_deg", "range": [0, 1]},
            ]
        )
    )
    about = {"frame": "part", "about_mm": [30.0, 20.0, 0.0]}
    plain_field = heights(vary.job_of(given, found, [0.0, 0.0, 0.0], about))
    assert np.allclose(plain_field.height, 0.2, atol=1e-5)
    thicker = heights(vary.job_of(given, found, [0.05, 0.0, 0.0], about))
    assert np.allclose(thicker.height, 0.25, atol=1e-5)
    assert np.allclose(thicker.stock_height, thicker.height, atol=1e-6)
    off = heights(vary.job_of(given, found, [0.05, 0.1, 0.2], about))
    slope = np.tan(np.radians(0.2))  # turned about y: less where x is larger
    wanted = 0.35 - slope * (off.points[:, 0] - 30.0)
    assert np.allclose(off.height, wanted, atol=5e-5)
    below = heights(vary.job_of(given, found, [0.0, 0.0, 0.5], about))
    assert ((below.flags & core.DEFECTIVE) != 0).any() and (below.height < 0).any()


def test_a_part_that_lies_deeper_is_ground_less_under_position_control(job):
    machine = {**job["belt_machine"], "control": "position"}
    poses = [{**pose, "z_mm": -0.1} for pose in job["programs"][0]["poses"]]
    job = {**job, "belt_machine": machine, "programs": [{**job["programs"][0], "poses": poses}]}
    found = vary.variables(study_of([{"key": "placement.z_mm", "range": [0, 1]}]))
    place = {"frame": "part", "about_mm": [0, 0, 0]}
    removed = [
        runs.run(vary.job_of(job, found, [z], place)).summary["removed_volume_mm3"]
        for z in (0.05, 0.0, -0.05)
    ]
    assert removed[0] > removed[1] > removed[2] > 0.0


# Batches -----------------------------------------------------------------------------------------------


def test_parts_of_a_batch_are_scans_and_jobs(tmp_path, job):
    import json

    other = plate_job()
    other["stock"]["allowance_mm"] = 0.33
    (tmp_path / "other.json").write_text(json.dumps(other))
    stocked(job, "mesh", tmp_path)
    entries = [
        {
            "key": "part",
            "parts": [
                {"job": "other.json"},
                {"name": "casting 7", "scan": "scan.off", "aligned": True},
            ],
        },
        force(values=[20, 30]),
    ]
    given = {"job": plate_job(), "vary": entries, "design": {"method": "grid"}}
    prepared = making.prepare(making.validate(given, tmp_path))
    assert prepared.rows == [("other", 20), ("other", 30), ("casting 7", 20), ("casting 7", 30)]
    made = [prepared.job(run) for run in prepared.runs]
    assert [one["stock"]["kind"] for one in made] == ["allowance"] * 2 + ["mesh"] * 2
    assert made[1]["stock"]["allowance_mm"] == 0.33 and made[1]["belt_machine"]["force_N"] == 30
    assert made[2]["stock"]["file"] == str(tmp_path / "scan.off")
    assert len({run.job_hash for run in prepared.runs}) == 4


def test_two_parts_of_one_name_are_refused(tmp_path, job):
    parts = [{"scan": "/a/one.off", "aligned": True}, {"scan": "/b/one.off", "aligned": True}]
    study = study_of([{"key": "part", "parts": parts}])
    found = vary.variables(study)
    stocked(job, "mesh", tmp_path)
    for part in study["vary"][0]["parts"]:
        part["scan"] = str(tmp_path / "scan.off")
    with pytest.raises(InputError, match="two parts are called 'scan'"):
        batch.parts(job, found)
