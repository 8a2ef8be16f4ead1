"""A study in the document: what varies, which runs are made, their table and its answers."""

from __future__ import annotations

import hashlib
import json
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

from ..base import schemas
from ..base.files import json_bytes, write_whole
from ..base.kinds import Context, Json
from ..engine import Cancelled, InputError, core
from ..studies import (
    answers,
    checking,
    design as designs,
    making,
    store as stores,
    table as tables,
    vary,
)
from . import job_inputs, result_files, stored_facts, study_keys
from .job_data import children, inspection
from .kinds import DocumentObject
from .properties import Key, Output, add_keys, add_outputs, to_job
from .proxy import Proxy
from .robot_path import RobotPath

KEYS = (
    Key("Vary", "JSON", "Study", "study.vary"),
    Key("Correlations", "JSON", "Study", "study.correlations"),
    Key("Method", "Enumeration", "Design", "study.design.method"),
    Key("Runs", "Integer", "Design", "study.design.runs"),
    Key("Seed", "Integer", "Design", "study.design.seed"),
    Key("Asked", "JSON", "Answers", "study.answers"),
)
OUTPUTS = (
    Output("RunsInAll", "Integer", "Study", "runs of the design"),
    Output("RunsDone", "Integer", "Study", "runs with figures"),
    Output("RunsFailed", "Integer", "Study", "runs that could not be run"),
    Output("Yield", "Float", "Study", "runs whose verdict is pass, percent; -1: not known"),
    Output("OutOfDate", "Bool", "Study", "an input, the tolerance or a setting has changed since"),
    Output("OpenedRun", "Integer", "Study", "run that the document was set to last; 0: none"),
    Output("Warnings", "StringList", "Study", "what the user should know of the runs"),
    stored_facts.output("Warnings", "Study"),
    Output("Design", "String", "Study", "the design as design.json has it", True),
    Output("Answers", "String", "Study", "answers as answers.json has them", True),
    Output("Base", "String", "Study", "the job's settings that were varied, as JSON", True),
    Output("Fingerprint", "String", "Study", "hash of what was run", True),
    Output("JobFingerprint", "String", "Study", "the same of the job alone", True),
    Output("OpenedFingerprint", "String", "Study", "the same of the job set to OpenedRun", True),
)
TABLE = "Table"


class Study(Proxy):
    """Proxy of the App::FeaturePython."""

    TYPE = "BeltGrinding::Study"
    VIEW = "StudyView"

    def add_properties(self, obj: DocumentObject) -> None:
        add_keys(obj, KEYS)
        if "Workers" not in obj.PropertiesList:
            text = "processes that run; 0: as many as there are cores, 1: one run after the other"
            obj.addProperty("App::PropertyInteger", "Workers", "Design", text)
        add_outputs(obj, OUTPUTS)
        if TABLE not in obj.PropertiesList:
            text = "a row a run, as table.csv has it"
            obj.addProperty("App::PropertyFileIncluded", TABLE, "Study", text)
            obj.setEditorMode(TABLE, 2)

    def execute(self, obj: DocumentObject) -> None:
        self.update(obj)

    def update(self, obj: DocumentObject) -> None:
        """Marks it as out of date; a job that was set to one of its runs is not."""
        job = obj.getParentGroup()
        if job is None or not obj.Fingerprint:
            return
        try:
            now = fingerprint(obj, job)
        except InputError:
            now = ""
        stale = now not in (obj.Fingerprint, obj.OpenedFingerprint) or not now
        if obj.OutOfDate != stale:
            obj.OutOfDate = stale

    def settings(self, obj: DocumentObject) -> dict[str, Any]:
        """As Resources/schema/study.schema.json has them, without the job."""
        data: dict[str, Any] = {}
        to_job(obj, KEYS, data)
        found = data["study"]
        found["vary"] = found.get("vary") or []
        return found

    def table(self, obj: DocumentObject) -> tables.Table | None:
        """The ``Table``; None before the first run. Raises InputError for a damaged document."""
        data = result_files.read(obj, TABLE)
        if data is None:
            return None
        design = json.loads(obj.Design)
        with tempfile.TemporaryDirectory(prefix="beltgrinding-") as folder:
            path = Path(folder, tables.FILE)
            write_whole(path, data)
            return tables.Table.read(path, design["varied"], design["figures"])

    def answers(self, obj: DocumentObject) -> dict[str, Any] | None:
        """What it answers, as ``studies.answers`` gives it; None where no run has figures."""
        return json.loads(obj.Answers) if obj.Answers else None


class Opened(NamedTuple):
    """What came of setting the document to a run."""

    left: list[
        str
    ]  # names of what varies that no property of the document holds: it stays as it is
    laid_anew: list[
        str
    ]  # labels of paths that follow the new settings: their poses are not the run's


def _hash(*data: Any) -> str:
    return hashlib.sha256(json.dumps(data, sort_keys=True, allow_nan=False).encode()).hexdigest()


def _job_fingerprint(job: DocumentObject) -> str:
    return _hash(job_inputs.fingerprint(job), inspection(job))


def fingerprint(obj: DocumentObject, job: DocumentObject) -> str:
    """Hash of all that a study depends on."""
    return _hash(_job_fingerprint(job), obj.Proxy.settings(obj))


class Work:
    """What is run of a job, collected here and now; ``find`` runs it, in any thread. Raises InputError."""

    def __init__(self, obj: DocumentObject, job: DocumentObject) -> None:
        settings = obj.Proxy.settings(obj)
        if not settings["vary"]:
            raise InputError(
                "objects.nothing_varies",
                "{object}: nothing varies; add a key of the job and its values",
                object=obj.Label,
            )
        rule = making.schema()
        self.study = schemas.checked({**settings, "job": ""}, rule, "study")
        self.workers = 0 if obj.Workers == 1 else obj.Workers or None
        self.fingerprint, self.job_fingerprint = fingerprint(obj, job), _job_fingerprint(job)
        self.base = study_keys.base(job)
        self.known = None  # runs of the same job with the same things varied
        if obj.Design and obj.JobFingerprint == self.job_fingerprint:
            if json.loads(obj.Design)["vary"] == self.study["vary"]:
                self.known = obj.Proxy.table(obj)

    def find(
        self,
        data: Json,
        context: Context = None,
        told: Callable[[making.Progress], object] | None = None,
    ) -> Found:
        """A ``Found`` for a job's data; of one that is cancelled, with the runs that had ended. Raises InputError, Cancelled
        if none had."""
        context = context or core.RunContext()
        study = {**self.study, "job": data}
        prepared = making.prepare(study, context)
        with tempfile.TemporaryDirectory(prefix="beltgrinding-study-") as folder:
            self._lay_down(prepared, folder)
            try:
                found = making.run(
                    prepared, folder, context, told, self._workers(prepared), read=()
                )
                made, cancelled = found.table, False
            except Cancelled:
                made, cancelled = self._what_is_there(prepared, folder), True
        answered = None
        if made.done.any():
            answered = answers.answers(study, prepared.design, made, None if cancelled else context)
            if not cancelled:
                checking.check(answered, study, context)
        return Found(self, made, prepared.design, answered, cancelled, prepared.warnings)

    def _workers(self, prepared: making.Prepared) -> int | None:
        """For a run or two, this process alone."""
        return 0 if self.workers is None and len(prepared.runs) < 3 else self.workers

    def _lay_down(self, prepared: making.Prepared, folder: Path | str) -> None:
        """What the document's table has already is not run again."""
        if self.known is None or not set(prepared.figures) <= set(self.known.names):
            return
        # By their values: FreeCAD writes a shape differently now and then, and with it the job's hash.
        kept, old, names = stores.Store(folder), self.known, prepared.names
        columns = [old[name].tolist() for name in names]
        rows = {_hash(values): row for row, values in enumerate(zip(*columns))}
        for run, values in zip(prepared.runs, prepared.rows):
            row = rows.get(_hash(tuple(values)))
            if row is None or old[tables.STATUS][row] == tables.OPEN:
                continue
            status = old[tables.STATUS][row]
            failed = status == tables.FAILED
            figures = {} if failed else {n: _plain(old[n][row]) for n in prepared.figures}
            kept.write(
                {
                    "job_hash": run.job_hash,
                    "status": status,
                    "figures": figures,
                    "error": old[tables.ERROR][row] if failed else None,
                    "seconds": 0.0,
                }
            )

    @staticmethod
    def _what_is_there(prepared: making.Prepared, folder: Path | str) -> tables.Table:
        path = Path(folder, tables.FILE)
        if not path.exists():
            raise Cancelled()
        made = tables.Table.read(path, prepared.names, prepared.figures)
        if not (made[tables.STATUS] != tables.OPEN).any():
            raise Cancelled()
        return made


def _plain(value: Any) -> Any:
    value = value.item() if hasattr(value, "item") else value
    return None if isinstance(value, float) and value != value else value


class Found:
    """A study's table with what the document keeps of it; made in any thread."""

    def __init__(
        self,
        work: Work,
        table: tables.Table,
        design: Json,
        answered: Json | None,
        cancelled: bool,
        warnings: list[core.Fact],
    ) -> None:
        self.work, self.table, self.design = work, table, design
        self.answers, self.cancelled, self.warnings = answered, cancelled, warnings
        self.file = result_files.Written({TABLE: table.csv_bytes()})


def store(obj: DocumentObject, found: Found) -> None:
    """Puts a ``Found`` into a Study object."""
    obj.Fingerprint = obj.OpenedFingerprint = obj.JobFingerprint = ""
    status = found.table[tables.STATUS]
    obj.RunsInAll = len(found.table)
    obj.RunsDone = int((status == tables.DONE).sum())
    obj.RunsFailed = int((status == tables.FAILED).sum())
    obj.Design = json.dumps({**found.design, "vary": found.work.study["vary"]}, allow_nan=False)
    obj.Answers = "" if found.answers is None else json_bytes(found.answers).decode()
    stored_facts.store(obj, "Warnings", found.warnings)
    obj.Base = json.dumps(found.work.base, allow_nan=False)
    whole = [one for one in (found.answers or {}).get("yield", ()) if one["of"] == "overall"]
    share = whole[0]["share"] if whole else None
    obj.Yield = -1.0 if share is None else 100.0 * share
    result_files.store(obj, found.file)
    obj.OpenedRun = 0
    obj.JobFingerprint = found.work.job_fingerprint
    obj.Fingerprint = found.work.fingerprint
    obj.OutOfDate = False


def open_run(obj: DocumentObject, number: int) -> Opened:
    """Sets the job's properties to what run ``number`` had. Returns an ``Opened``. Raises InputError; then nothing is
    changed."""
    job, made = obj.getParentGroup(), obj.Proxy.table(obj)
    if made is None:
        raise InputError("objects.study_not_run", "{object}: is not run yet", object=obj.Label)
    if not 1 <= number <= len(made):
        raise InputError(
            "objects.no_such_run",
            "{object}: has no run {run}; it has {count}",
            object=obj.Label,
            run=number,
            count=len(made),
        )
    obj.Proxy.update(obj)
    if obj.OutOfDate:
        raise InputError(
            "objects.study_out_of_date",
            "{object}: the job or the study has changed since; run it again, or undo the change",
            object=obj.Label,
        )
    settings = obj.Proxy.settings(obj)
    settings = schemas.checked({**settings, "job": ""}, making.schema(), "study")
    design = json.loads(obj.Design)
    values = {name: _plain(made[name][number - 1]) for name in design["varied"]}
    paths = {path.Name: path.Proxy.digest(path) for path in children(job, RobotPath)}
    left = study_keys.put_in(job, json.loads(obj.Base), settings, values)
    job.Document.recompute()
    laid_anew = [
        path.Label
        for path in children(job, RobotPath)
        if path.Proxy.digest(path) != paths.get(path.Name)
    ]
    obj.OpenedRun = number
    obj.OpenedFingerprint = fingerprint(obj, job)
    obj.Proxy.update(obj)
    return Opened(left, laid_anew)


def check_varied(entries: Iterable[Json]) -> list[vary.Variable]:
    """Raises InputError for what is no ``vary`` of a study. Returns [Variable]."""
    rule = making.schema()["properties"]["vary"]
    checked = schemas.checked(list(entries), rule, "vary") if entries else []
    return vary.variables({"vary": checked})


def check_correlated(pairs: Iterable[Json], entries: Iterable[Json], method: str) -> None:
    """Raises InputError for ``pairs`` that are no ``correlations`` of a study with this ``vary`` and method."""
    rule = making.schema()["properties"]["correlations"]
    checked = schemas.checked(list(pairs), rule, "correlations") if pairs else []
    study = {"correlations": checked, "design": {"method": method}}
    designs.correlations(study, check_varied(entries))
