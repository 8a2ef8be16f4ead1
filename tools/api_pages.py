"""api_pages.py XML FOLDER: writes the reference of the C++ library, which Doxygen has read into the folder XML, as
pages of the manual: one for each public header, and index.md, which leads to all.
"""

import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

LONGEST = 88  # characters of a signature on one line
NAMESPACE = "beltgrinding::"


def said(node):
    """The text of a node as code: one line, with & and * beside the type."""
    text = " ".join("".join(node.itertext()).split()).replace(NAMESPACE, "")
    text = re.sub(r"<\s+", "<", re.sub(r"\s+>", ">", text))
    return re.sub(r"\s+([&*]+)\s*", r"\1 ", text).strip()


class Pages:
    """The headers' pages, and where on them each class and function is."""

    def __init__(self, folder):
        self.compounds = {
            path.stem: ET.parse(path).getroot().find("compounddef")
            for path in sorted(folder.glob("*.xml"))
            if path.stem not in ("index", "Doxyfile")
        }
        self.headers = {
            one.findtext("compoundname"): one
            for one in self.compounds.values()
            if one.get("kind") == "file" and one.findtext("compoundname").endswith(".h")
        }
        free = self.compounds["namespacebeltgrinding"].iter("memberdef")
        self.free = {header: [] for header in self.headers}
        for member in free:
            self.free[Path(member.find("location").get("file")).name].append(member)
        self.place = {}  # by Doxygen's name: page and anchor
        for header in self.headers:
            for one in [*self.classes(header), *self.free[header]]:
                anchor = re.sub(r"[^\w-]", "", self.title(one).lower())
                self.place[one.get("id")] = f"{Path(header).stem}.md#{anchor}"

    def classes(self, header):
        return [self.compounds[one.get("refid")] for one in self.headers[header].iter("innerclass")]

    def title(self, one):
        return (one.findtext("name") or one.findtext("compoundname")).removeprefix(NAMESPACE)

    def prose(self, one):
        """What is said of a class or member, as Markdown on one line."""
        parts = (one.find("briefdescription"), one.find("detaileddescription"))
        return " ".join(" ".join(self._markdown(part).split()) for part in parts).strip()

    def _markdown(self, node):
        text = self._escaped(node.text)
        for child in node:
            if child.tag == "computeroutput":
                text += f"`{''.join(child.itertext())}`"
            elif child.tag == "ref" and child.get("refid") in self.place:
                text += f"[{self._markdown(child)}]({self.place[child.get('refid')]})"
            else:
                text += self._markdown(child) + (" " if child.tag == "para" else "")
            text += self._escaped(child.tail)
        return text

    @staticmethod
    def _escaped(text):
        return re.sub(r"([\\`*_<>\[\]|])", r"\\\1", text or "")

    def declared(self, one):
        """A member as it is declared."""
        kind, name = one.get("kind"), self.title(one)
        if kind == "typedef":
            return f"using {name} = {said(one.find('type'))};"
        if kind == "enum":
            return f"enum {'class ' if one.get('strong') == 'yes' else ''}{name}"
        if kind == "variable":
            begin = said(one.find("initializer")) if one.find("initializer") is not None else ""
            return f"{said(one.find('type'))} {name} {begin}".strip()
        given = []
        for part in one.iter("param"):
            default = part.find("defval")
            text = f"{said(part.find('type'))} {part.findtext('declname') or ''}".strip()
            given.append(text + ("" if default is None else f" = {said(default)}"))
        begin = f"{said(one.find('type'))} {name}(".strip()
        end = re.sub(r"\s*=\s*", " = ", said(one.find("argsstring")).rpartition(")")[2])
        end = f") {end.strip()};" if end else ");"
        if len(begin + ", ".join(given) + end) <= LONGEST:
            return begin + ", ".join(given) + end
        return begin + "\n    " + ",\n    ".join(given) + end

    def member(self, one):
        """Lines on a function, type or enumeration."""
        yield from ("```cpp", self.declared(one), "```", "", self.prose(one), "")
        values = list(one.iter("enumvalue"))
        if values:
            yield from ("| value | meaning |", "| --- | --- |")
            yield from (f"| `{value.findtext('name')}` | {self.prose(value)} |" for value in values)
            yield ""

    def type(self, one):
        """Lines on a class: what it is, its variables as a table, then the rest."""
        bases = [base.text.removeprefix(NAMESPACE) for base in one.iter("basecompoundref")]
        begin = f"{one.get('kind')} {self.title(one)}"
        yield from ("```cpp", begin + (f" : {', '.join(bases)}" if bases else ""), "```", "")
        yield from (self.prose(one), "")
        members = [m for m in one.iter("memberdef") if m.get("prot") != "private"]
        variables = [m for m in members if m.get("kind") == "variable"]
        if variables:
            yield from ("| member | meaning |", "| --- | --- |")
            for m in variables:
                yield f"| `{self.declared(m)}` | {self.prose(m)} |"
            yield ""
        for m in members:
            if m.get("kind") != "variable" and self.prose(m):
                yield from self.member(m)

    def page(self, header):
        """The text of a header's page."""
        lines, before = [f"# {header}", "", f"    #include <beltgrinding/{header}>", ""], None
        for one in self.classes(header):
            lines += [f"## {self.title(one)}", "", *self.type(one)]
        for one in self.free[header]:
            if self.title(one) != before:  # overloads are under one heading
                before = self.title(one)
                lines += [f"## {before}", ""]
            lines += self.member(one)
        return "\n".join(lines)

    def index(self, begin):
        """The text of the first page, which begins with ``begin``."""
        lines = [begin, "| header | declares |", "| --- | --- |"]
        for header in self.headers:
            names = {
                self.title(one): self.place[one.get("id")]
                for one in [*self.classes(header), *self.free[header]]
            }
            links = ", ".join(f"[{name}]({place})" for name, place in names.items())
            lines.append(f"| [{header}]({Path(header).stem}.md) | {links} |")
        return "\n".join(lines) + "\n"


def main():
    source, folder = map(Path, sys.argv[1:])
    pages = Pages(source)
    folder.mkdir(parents=True, exist_ok=True)
    root = Path(__file__).resolve().parents[1]
    begin = (root / "docs" / "api" / "mainpage.md").read_text("utf-8")
    example = (root / "examples" / "plate.cpp").read_text("utf-8")
    begin = begin.replace("`docs/library.md`", "[The C++ library](../library.md)")
    text = pages.index(begin.replace("\\include plate.cpp\n", ""))
    (folder / "index.md").write_text(f"{text}\n```cpp\n{example}```\n", "utf-8")
    for header in pages.headers:
        (folder / f"{Path(header).stem}.md").write_text(pages.page(header), "utf-8")


if __name__ == "__main__":
    main()
