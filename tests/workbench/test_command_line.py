"""The command line as a person meets it: help by task, examples that can be pasted, what was meant, completion."""

import json
import re
import shlex
import shutil
import subprocess
import sys

import pytest

import beltgrinding
from beltgrinding import cli
from beltgrinding.cli import background, completion, man, parser
from beltgrinding.cli.examples import EXAMPLES

COMMANDS = cli.command_line()


def call(*words, shell=None):
    command = shell or [sys.executable, "-m", "beltgrinding", *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def test_every_command_stands_under_one_task():
    listed = [name for _, names in parser.TASKS for name in names]
    assert sorted(listed) == sorted(COMMANDS.commands)


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(COMMANDS.commands))
def test_examples_are_read(name):
    assert len(EXAMPLES[name]) >= 5
    for line in EXAMPLES[name]:
        words = shlex.split(re.split(" [<>] ", line)[0])
        read = cli.command_line().parse_args(words)
        assert read.command == name
        assert f"beltgrind {line}" in COMMANDS.commands[name].format_help()


@pytest.mark.parametrize(
    "words, told",
    (
        (["gind", "a.step"], "there is no command 'gind'; did you mean grind?"),
        (["run", "job.json", "--outptu", "x", "-o", "y"], "; did you mean --output?"),
        (["xyzzy"], "there is no command 'xyzzy'\n"),
        (["help", "verfy"], "there is no command 'verfy'; did you mean verify?"),
    ),
)
def test_a_misspelt_word_says_what_was_meant(words, told):
    done = call(*words)
    assert done.returncode == 2
    assert told in done.stderr
    as_json = call(*words, "--json-errors")
    assert told.strip() in json.loads(as_json.stderr)["error"]["message"]


def test_an_options_value_is_no_command():
    done = call("--language", "de", "help", "run")
    assert done.returncode == 0, done.stderr


def test_help_and_version():
    assert call("help").stdout == call("--help").stdout
    assert call("help", "run").stdout == call("run", "--help").stdout
    assert call("--version").stdout == f"beltgrind {beltgrinding.__version__}\n"
    assert json.loads(call("--versions").stdout)["beltgrinding"] == beltgrinding.__version__
    nothing = call()
    assert nothing.returncode == 2 and "Grind a part:" in nothing.stderr


def test_the_bar_tells_the_time_left():
    line = background.progress_line
    assert line(0.0, 0.0) == "[" + 24 * " " + "]   0 %"
    assert line(0.5, 90.0) == "[" + 12 * "#" + 12 * " " + "]  50 %, 1 min 30 s left"
    assert line(0.9, 9.0).endswith(" 90 %, 1 s left")
    assert line(0.5, 1.0).endswith(" 50 %")


def completed(shell, line, tmp_path):
    """What a shell proposes for a line that is begun."""
    script = tmp_path / f"_beltgrind.{shell}"
    script.write_text(completion.script(shell, COMMANDS))
    if shell == "fish":
        text = f"source {script}; complete -C '{line}'"
        env = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin", "XDG_CONFIG_HOME": str(tmp_path)}
        done = subprocess.run([shell, "-c", text], capture_output=True, text=True, env=env)
        assert not done.stderr, done.stderr
        return [one.split("\t")[0] for one in done.stdout.splitlines()]
    words = line.split(" ")
    text = (
        f"source {script}; COMP_WORDS=({' '.join(shlex.quote(w) for w in words)}); "
        f"COMP_CWORD={len(words) - 1}; _beltgrind; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    )
    done = call(shell=[shell, "-c", text])
    assert not done.stderr, done.stderr
    return done.stdout.split()


@pytest.mark.parametrize("shell", ("bash", "fish"))
@pytest.mark.parametrize(
    "line, wanted",
    (
        ("beltgrind ver", ["verdict", "verify"]),
        ("beltgrind help gri", ["grind"]),
        ("beltgrind run --wan", ["--wanted"]),
        ("beltgrind presets wh", ["wheels"]),
        ("beltgrind report --language d", ["de"]),
    ),
)
def test_shells_complete(shell, line, wanted, tmp_path):
    if not shutil.which(shell):
        pytest.skip(f"{shell} is not installed")
    found = completed(shell, line, tmp_path)
    assert sorted(one for one in found if one in wanted) == wanted


def test_zsh_reads_its_script(tmp_path):
    if not shutil.which("zsh"):
        pytest.skip("zsh is not installed")
    script = tmp_path / "_beltgrind"
    script.write_text(completion.script("zsh", COMMANDS))
    text = (
        f"autoload -U compinit; compinit -D -u; source {script}; print -r -- ${{_comps[beltgrind]}}"
    )
    done = call(shell=["zsh", "-f", "-c", text])
    assert (done.stdout, done.stderr) == ("_beltgrind\n", "")


def test_each_command_has_a_man_page(tmp_path):
    man.write(tmp_path)
    pages = {path.name for path in tmp_path.iterdir()}
    assert pages == {"beltgrind.1", *(f"beltgrind-{name}.1" for name in COMMANDS.commands)}
    run = (tmp_path / "beltgrind-run.1").read_text()
    assert "\\-\\-wanted" in run and "beltgrind run job.json \\-o result" in run
    if shutil.which("groff"):
        for path in tmp_path.iterdir():
            done = call(shell=["groff", "-man", "-Tutf8", "-ww", "-z", str(path)])
            assert not done.stderr, done.stderr
