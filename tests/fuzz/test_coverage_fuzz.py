"""A short run of coverage_fuzz.py, and proof that it keeps what reaches new code and tells findings."""

import random
import signal
from pathlib import Path

import pytest

import coverage_fuzz as guided
import fuzz_programs as fuzzing
import structure
from beltgrinding.programs.registry import READERS

HERE = Path(__file__).resolve().parent

INPUTS = 25  # of each language
KRL = {"a.src": b"DEF a()\nLIN {X 1,Y 2,Z 3,A 4,B 5,C 6}\nEND\n"}


@pytest.fixture(autouse=True)
def alarmed():
    before = signal.signal(signal.SIGPROF, fuzzing._alarm)
    yield
    signal.signal(signal.SIGPROF, before)


@pytest.mark.parametrize("suffix", guided.languages())
def test_a_short_run(suffix):
    parents, known = guided.start(suffix, None, [fuzzing.OWN])
    first = len(known)
    assert first > 100
    counts, findings = guided.explore(suffix, parents, known, "ci", INPUTS)
    assert not findings and sum(counts.values()) == INPUTS
    assert len(known) >= first


def test_new_code_is_seen_once(tmp_path):
    arcs = guided.Arcs()
    assert guided.run(".src", KRL, tmp_path, arcs) == (None, "read")
    assert arcs.new and arcs.new <= arcs.known
    guided.run(".src", KRL, tmp_path, arcs)
    assert not arcs.new
    guided.run(
        ".src", {"a.src": KRL["a.src"].replace(b"END", b"CIRC {X 1},{X 2}\nEND")}, tmp_path, arcs
    )
    assert arcs.new


@pytest.mark.parametrize("wrong, kind", [("crash", "crash"), ("die", "crash"), ("spin", "slow")])
def test_findings_are_told(monkeypatch, wrong, kind):
    def reader(path):
        if wrong == "crash":
            return 1 / 0
        if wrong == "die":
            import os

            os._exit(3)
        while True:
            pass

    monkeypatch.setattr(fuzzing, "read_program", reader)
    monkeypatch.setattr(guided, "WATCHED_LIMIT", 0.2)
    monkeypatch.setattr(guided, "LIMIT", 0.2)
    _, findings = guided.explore(".src", [KRL], set(), "0", 1)
    assert [found[1] for found in findings] == [kind] and findings[0][0]


def test_what_is_kept_is_read_again(tmp_path):
    guided.save(tmp_path / "src", {"a.src": b"DEF b()\nEND\n"})
    parents, _ = guided.start(".src", tmp_path, [fuzzing.OWN])
    assert {"a.src": b"DEF b()\nEND\n"} in parents


def test_words_of_the_readers_are_known():
    guided.start(".src", None, [fuzzing.OWN])
    assert b"ENDSWITCH".lower() in structure.words_of(READERS[".src"], [])


@pytest.mark.parametrize("change", dict.fromkeys(structure.CHANGES))
def test_every_change_changes_and_repeats(change):
    data, words = b"FOR I=1 TO 5\nLIN {X 1}\nENDFOR\nEND\n", [b"WHILE", b"IF"]
    changed = {change(data, words, random.Random(seed)) for seed in range(20)}
    assert changed - {data}
    assert change(data, words, random.Random(3)) == change(data, words, random.Random(3))
    change(b"", words, random.Random(3))
