"""TP programs as controllers in other languages write them, in English words.

German: all words that differ between the English and the German listings of 312 programs which one
controller wrote in both languages (R-J3iC and R-30iA, JuniorNatalin/VASC on GitHub). A word that is not
among them stays as it is, and its statement is reported as one that is not understood. Listings in other
languages were not found.
"""

import re
from collections.abc import Iterable

HEADER = re.compile(r"\s*(?:EIGN\.|KOMMENTAR|ERSTELL|ZEILEN|SCHUTZ)\s*=")
SIGNS = re.compile(r"\s*\d+:\s*(?:AUFRUF|BENUTZER_NUM|SPRUNG|WENN|WKZ_NUM)\b|[^!']*\bKONFIG\s*:")
GERMAN = {
    "AUFRUF": "CALL",
    "BALM": "UALM",
    "BEDINGUNG": "CONDITION",
    "BENUTZER_NUM": "UFRAME_NUM",
    "ENDE": "END",
    "FB-PSPS": "TC_ONLINE",
    "FREIG.": "UNLOCK",
    "IRQ": "SKIP",
    "IST": "SELECT",
    "Interrupt": "Skip",
    "LABEL": "LBL",
    "MELDUNG": "MESSAGE",
    "SONST": "ELSE",
    "SPERRE": "LOCK",
    "SPRUNG": "JMP",
    "STOPP": "STOP",
    "TRAGLST": "PAYLOAD",
    "WARTE": "WAIT",
    "WENN": "IF",
    "WKZ_NUM": "UTOOL_NUM",
    "max_Geschw.": "max_speed",
}
MM_PER_S = {"mm/sek": "mm/sec"}  # what the writer of changes finds in a listing, in English
# (pattern, English), in this order
GERMAN_FORMS = [
    (re.compile(r"\bZEIT VOR\b"), "TB"),
    (re.compile(r"\bWEG VOR\b"), "DB"),
    (re.compile(r"\bWKZ_Offset\s*,"), "Tool_Offset,"),
    (re.compile(r"(?<=\d)(\s*m?m?/?)sek\b"), r"\1sec"),
    (re.compile(r"(?<=\])(\s*m?m?/?)sek\b"), r"\1sec"),  # R[1]mm/sek
    (re.compile(r"\[&\]"), "AND"),
    (re.compile(r"\[\+\]"), "OR"),
    (re.compile(r"(?<![\w$.])gA\["), "GO["),
    (re.compile(r"(?<![\w$.])gE\["), "GI["),
    (re.compile(r"(?<![\w$.])A\["), "DO["),
    (re.compile(r"(?<![\w$.])E\["), "DI["),
    (re.compile(r"(?<![\w$.])i\["), "R["),
    (re.compile(r"(?<=[=(])AN\b"), "ON"),
    (re.compile(r"(?<=[=(])AUS\b"), "OFF"),
]
GERMAN_WORD = re.compile(
    rf"(?<![\w$.])(?:{'|'.join(re.escape(w) for w in sorted(GERMAN, key=len, reverse=True))})(?![\w])"
)


def is_german(lines: Iterable[str]) -> bool:
    """Whether a program is written in German: its head, its statements or its positions."""
    return any(HEADER.match(text) or SIGNS.match(text) for text in lines)


def english(text: str) -> str:
    """A statement of a German listing in English words; comments stay."""
    if text.startswith(("!", "//", "--")):
        return text
    for pattern, word in GERMAN_FORMS:
        text = pattern.sub(word, text)
    return GERMAN_WORD.sub(lambda match: GERMAN[match.group()], text)
