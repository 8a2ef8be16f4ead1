"""What the documentation promises."""

import json
import re

from support.freecad import ROOT


def blocks(page, heading):
    """The indented blocks under a heading of a page, each as a text."""
    part = page.split(f"## {heading}\n")[1].split("\n## ")[0]
    found = re.findall(r"(?:^ {4}.*\n|^\n(?= {4}))+", part, re.M)
    return [re.sub(r"^ {4}", "", one, flags=re.M).strip("\n") for one in found]


def test_the_readme_macro_prints_what_it_says(freecad):
    macro, wanted = blocks((ROOT / "README.md").read_text(), "A macro")
    assert sum(bool(line) for line in macro.splitlines()) < 10
    output = freecad.run(macro + "\n")
    (line,) = re.findall(r"\d+\.\d % in tolerance, .*", output)
    share, told = (float(one.split()[0]) for one in (line, wanted))
    # Another Debian's CAD kernel samples the surface a little differently.
    assert abs(share - told) <= 0.1 and line.split("%")[1] == wanted.split("%")[1]
    assert (freecad.folder / "tap.html").stat().st_size > 1e6


def test_the_readme_names_commands_that_there_are():
    from beltgrinding import cli

    (commands,) = blocks((ROOT / "README.md").read_text(), "The command line")
    for line in commands.splitlines():
        words = line.split("#")[0].split()
        assert words[0] == "beltgrind"
        assert cli.command_line().parse_args(words[1:]).command == words[1]


def keys(rule, name=""):
    """(dotted name, rule) of every key of the schema."""
    for key, value in rule.get("properties", {}).items():
        full = f"{name}.{key}" if name else key
        array = value.get("type") == "array" and "properties" in value.get("items", {})
        if "$ref" not in value:
            yield full, value
        yield from keys(value["items"] if array else value, full + ("[]" if array else ""))


def test_the_job_files_page_has_every_key_with_its_default():
    schema = json.loads((ROOT / "Resources" / "schema" / "job.schema.json").read_text())
    page = (ROOT / "docs" / "job-file.md").read_text()
    rows = dict(re.findall(r"^\| (\S+) \| (.*?) \|", page, re.M))
    found = dict(keys(schema))
    assert len(found) > 50
    for name, rule in found.items():
        assert name in rows, name
        if "default" in rule and not isinstance(rule["default"], dict) and "properties" not in rule:
            assert rows[name] == f"`{json.dumps(rule['default'])}`", name
    ours = {name for name in rows if name not in ("key", "---")}
    frames = {name for name in ours if "a frame" in page.split(f"| {name} |")[1].split("\n")[0]}
    assert ours - frames <= set(found)


def test_every_link_of_the_documentation_leads_somewhere():
    for page in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]:
        for target in re.findall(r"\]\(([^)#]+)", page.read_text()):
            assert "://" in target or (page.parent / target).exists(), (page.name, target)
