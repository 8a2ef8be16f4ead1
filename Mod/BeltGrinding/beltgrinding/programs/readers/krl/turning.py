"""How KRL turns the tool on the way: $ORI_TYPE and $CIRC_TYPE."""

import re

OWN = re.compile(r"\$(ORI|CIRC)_TYPE\s*=\s*#(\w+)", re.IGNORECASE)
KINDS = {
    "ori": {"var": "", "variable": "", "constant": "hold", "const": "hold"},
    "circ": {"base": "", "path": "path"},
}


class Turning:
    """What holds where the program stands: assigned, by an inline form's LDAT, or behind WITH."""

    def __init__(self, values):
        self.values, self.block, self.said = values, "", set()  # block: the SPLINE statement around

    def take(self, ldat):
        """As BAS(#CP_PARAMS) does."""
        for kind in KINDS:
            word = ldat.get(f"{kind}_typ") if isinstance(ldat, dict) else None
            if isinstance(word, str):
                self.values[f"${kind}_type", ()] = word

    def reset(self):
        """As BAS(#INITMOV) does."""
        for kind in KINDS:
            self.values.pop((f"${kind}_type", ()), None)

    def of(self, text, line, problem):
        """The ``turn`` of a Motion by a statement; what is not followed is a problem, once."""
        words = {kind: self.values.get((f"${kind}_type", ())) for kind in KINDS}
        for where in (self.block, text):
            words.update((kind.lower(), word) for kind, word in OWN.findall(where))
        found = []
        for kind, known in KINDS.items():
            word = str(words[kind] or "").lower().lstrip("#")
            if word and word not in known and (kind, word) not in self.said:
                self.said.add((kind, word))
                problem(
                    line,
                    "programs.krl.turning",
                    "{name} is {word}, which depends on the robot's joints; here the tool turns "
                    "evenly from the start's orientation to the target's, from this line on",
                    name=f"${kind.upper()}_TYPE",
                    word=f"#{word.upper()}"[:20],
                )
            found.append(known.get(word, ""))
        return " ".join(filter(None, found))
