"""German texts have one word for a thing, and address nobody as a friend."""

import json
import re

from support.freecad import ROOT

# What a text may not have: what it has in place of it.
TERMS = {
    r"Abtastpunkt": "Stützpunkt",
    r"Zeilen(bahn|abstand)": "Rasterbahn, Bahnabstand",
    r"\bBandmaschine": "Bandschleifmaschine",
    r"\b(Rad|Rades|Rads|Kontaktrad)\b": "Scheibe",
    r"Kranz": "Belag",
    r"Überlauf": "Auslauf",
    r"\bSoll(s|fl|ob)?\b": "Entwurf",
    r"\b(Job|Jobs)\b": "Auftrag",
}
# The mouse's wheel; what INFORM and SLURM call jobs.
OTHER_THINGS = {"Rad": "Taste", "Job": "INFORM|programs|Array"}
FRIEND = re.compile(
    r"(?:^|[;:,] )(nimm|gib|stelle?|prüfe?|setze?|wähle|schreibe?|nenne|lege?|ändere|öffne|lade)\b"
)


def texts(node, path=()):
    """(path of keys, text) of all texts."""
    for key, value in node.items():
        if isinstance(value, dict):
            yield from texts(value, (*path, key))
        elif isinstance(value, str):
            yield (*path, key), value


def wrong(path, text):
    """What is wrong with a German text."""
    for term, better in TERMS.items():
        if (found := re.search(term, text)) is None:
            continue
        other = OTHER_THINGS.get(found.group()[:3])
        if other is None or not re.search(other, f"{path} {text}"):
            yield f"{found.group()}: {better}"
    if found := FRIEND.search(text):
        yield f"{found.group(1)}: the infinitive"


def test_one_word_for_a_thing():
    german = json.loads((ROOT / "Resources" / "messages" / "de.json").read_text("utf-8"))
    all_texts = list(texts(german))
    assert len(all_texts) > 3000
    found = [(path[-1], one) for path, text in all_texts for one in wrong(path, text)]
    assert not found, "\n".join(f"{key}: {one}" for key, one in found)


def test_each_rule_finds_what_it_is_for():
    for text in (
        "der Abtastpunkt",
        "das Rad setzt auf",
        "unter dem Soll",
        "; gib ihn an",
        "den Job",
    ):
        assert list(wrong(("a",), text)), text
    for text in ("Sollwert", "Linke Taste, Rad vergrößert", "kein INFORM-Job", "eine Vorgabe"):
        assert not list(wrong(("a",), text)), text
