"""What the documentation promises."""

import json
import re

from support.freecad import ROOT


def test_the_readme_macro_runs_as_it_stands(freecad):
    macro = (ROOT / "README.md").read_text().split("## A macro")[1].split("## ")[0]
    lines = [line[4:] for line in macro.splitlines() if line.startswith("    ")]
    assert sum(bool(line) for line in lines) < 15
    make = "from beltgrinding.examples import blade\nblade.make('build/demo')\n"
    output = freecad.run(make + "\n".join(lines) + "\n")
    share = float(re.search(r"^(\d+\.\d+) -\d+", output, re.M).group(1))
    tutorial = (ROOT / "docs" / "tutorial.md").read_text()
    told = float(re.search(r"^\| In tolerance \| ([\d.]+) % \|$", tutorial, re.M).group(1))
    # Another Debian's CAD kernel samples the surface a little differently.
    assert abs(share - told) < 0.1
    assert f"{told:.2f} % in tolerance" in macro
    assert (freecad.folder / "blade.FCStd").is_file()


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
