"""What KRL's motions take from the controller's variables: $BASE, $TOOL, $VEL, $APO, $IPO_MODE, and how BAS and
inline forms set them."""

from __future__ import annotations

import re
from collections.abc import Hashable, Sequence
from typing import Any

import numpy as np

from ...program import Fact, Unknown, Why
from .parts import Parts
from .expression import FRAME, components_of, frame_of, lacking, unknown_function
from .numbers import number
from .turning import NAMES as TURNING
from .values import Lost, Members, Steps, no_value, written

MAX_NAME = 60  # characters of a frame's
MAX_SPEED = 1e6  # m/s; beyond, the file is damaged
FRAMES = ("$tool", "$base")
MODES = ("#base", "#tcp")
HOME = re.compile(r"FHOME\d?")
NAMES = re.compile(r"(?<![\w$.#])\$?[A-Za-z_]\w*")
# What a BAS sets: {its first argument: variables}; FDAT: the frames, where an inline form gave FDAT_ACT.
FDAT = (*FRAMES, "$ipo_mode")
BAS_SETS: dict[str, tuple[str, ...]] = {
    "#cp_params": ("$vel", "$apo", *FDAT),
    "#ptp_params": FDAT,
    "#frames": FDAT,
    "#vel_cp": ("$vel",),
    "#tool": ("$tool",),
    "#base": ("$base",),
    "#ex_base": ("$base",),
    "#cp_dat": ("$apo",),
    **dict.fromkeys(
        "#vel_ptp #acc_ptp #acc_cp #acc_glueing #ptp_dat #out_sync #out_async #group #tq_state".split(),
        (),
    ),
}
ALL = ("$vel", "$apo", *FDAT)
OF_TURNING = (("ori1",), ("ori2",))  # parts of $VEL that say nothing of the path speed


class Settings(Parts):
    """Part of the interpreter (reader.py); what it needs of the others is theirs."""

    def store(self, line: int, name: str, steps: Steps, value: Any, text: str = "") -> None:
        """Assigns; what a motion takes from it and is not known is told and named. ``text``: the value's."""
        name = "$ipo_mode" if name == "$ipo_frame" else name
        if name == "$ipo_mode" and not isinstance(value, Lost) and value not in MODES:
            told = Fact("programs.krl.ipo_mode", "it is neither #BASE nor #TCP")
            value = Lost(told)
        self.values.assign(name, steps, value)
        if name in FRAMES:
            self.settle_frame(line, name, text)
        elif name == "$vel" and steps not in OF_TURNING:
            self.settle_speed(line)
        elif name == "$ipo_mode" and isinstance(self.values.peek(name), Lost):
            self.unknown(line, name, self.values.peek(name))

    def lose(self, line: int, name: str, steps: Steps, told: Why) -> None:
        """What a path names is not known from here on, since something may have changed it."""
        if self.beside:
            self.values.lose_always(name, told)
        elif name == "$vel":
            if self.speed_now() is not None:
                self.problem(
                    line,
                    "programs.krl.speed_lost",
                    "the path speed is not known after this; the default is used",
                )
            self.values.lose(name, told, steps)
            return
        else:
            self.values.lose(name, told, steps)
        if name in FRAMES:
            words = self.name_frame(f"as line {line} may set it", self.values.versions[name], name)
            self.values.assign(name, (), Lost(told, words))

    def unknown(self, line: int, name: str, lost: Lost) -> None:
        self.problem(
            line,
            "programs.unknown_because",
            "{name} is not known: {reason}",
            name=name.upper(),
            reason=Unknown(lost.told).fact,
        )

    def settle_speed(self, line: int) -> None:
        """Tells a path speed that is not known after an assignment."""
        value = self.values.peek("$vel", ("cp",))
        if self.speed_now() is not None:
            return
        if value is None:
            value = Lost(Fact("programs.krl.no_speed", "it gives no speed (CP)"))
        elif not isinstance(value, Lost):
            self.problem(
                line,
                "programs.krl.speed_no_number",
                "the path speed is no sensible number; it is not known",
            )
            return
        self.unknown(line, "$vel.cp", value)

    def speed_now(self) -> float | None:
        """mm/s, or None."""
        value = self.values.peek("$vel", ("cp",))
        if isinstance(value, float) and 0 < value < MAX_SPEED:
            return 1000.0 * value
        return None

    def set_speed(self, line: int, text: str) -> None:
        """As $VEL.CP = text."""
        self.store(line, "$vel", ("cp",), self.value_or_lost(text))

    def settle_frame(self, line: int, name: str, text: str) -> None:
        """Gives $TOOL or $BASE, where its numbers are not known, words that no other frame has."""
        value = self.values.peek(name)
        if isinstance(value, Members) and all(isinstance(value.get(k), float) for k in FRAME):
            return
        if isinstance(value, Lost) and value.words:
            return
        key: Hashable
        lost: Any
        if isinstance(value, Lost) and text:
            words = " ".join(text.split())[:MAX_NAME].upper()
            found = {one.lower() for one in NAMES.findall(text)}
            key = tuple((one, self.values.versions.get(one, 0)) for one in sorted(found - {name}))
        else:
            words, key = f"{name} as line {line} sets it".upper(), self.values.versions[name]
        if isinstance(value, Members):
            missing = [k for k in FRAME if not isinstance(value.get(k), float)]
            lost = next((value[k] for k in missing if isinstance(value.get(k), Lost)), None)
            lost = lost or Lost(lacking(value, missing).told)
        else:
            lost = value
            if not isinstance(lost, Lost):
                told = Fact("programs.krl.no_frame", "it is no frame")
                lost = Lost(no_value(name) if value is None else told)
        self.unknown(line, name, lost)
        self.values.assign(name, (), Lost(lost.told, self.name_frame(words, key)))

    def name_frame(self, words: str, *key: Hashable) -> str:
        """Words for a frame that is not known: the same for the same key, those of no other."""
        known = self.frame_names.get((words, key))
        if known is None:
            count = self.frame_counts[words] = self.frame_counts.get(words, 0) + 1
            known = self.frame_names[words, key] = words if count == 1 else f"{words} ({count})"
        return known

    def frame_value(self, name: str, steps: Steps) -> Members | Lost:
        """The frame that a path names, or one that only the controller knows, by its name."""
        value = self.values.look(name, steps)
        if value is None:
            value = self.given_for(name, steps, "frame")
        if isinstance(value, Members):
            return value
        if value is not None:
            raise Unknown("programs.krl.no_frame", "it is no frame")
        words = written(name, steps)
        return Lost(no_value(words), words[:MAX_NAME])

    def numbered_frame(self, what: str, index: object) -> Members | Lost:
        """That of TOOL_DATA or BASE_DATA (``what``: tool, base) by its number, a value; 0: $NULLFRAME."""
        at = number(index)
        if at == 0:
            return Members(dict.fromkeys(FRAME, 0.0))
        if not 0 < at < 1000 or at != int(at):
            raise Unknown("programs.krl.frame_number", "its number is not one of a frame")
        return self.frame_value(f"{what}_data", ((int(at),),))

    def set_frame(self, line: int, what: str, text: str) -> None:
        """BAS(#TOOL, n), BAS(#BASE, n): as $TOOL=TOOL_DATA[n]."""
        try:
            value: Any = self.numbered_frame(what, self.evaluate(text))
        except Unknown as unknown:
            value = Lost(unknown.told)
        self.store(line, f"${what}", (), value, f"{what}_data[{text}]")

    def of_fdat(self, fdat: Any, what: str) -> Any:
        """(what the motion's TCP is by an inline form's FDAT, what its base is): with the tool in the room
        (IPO_FRAME #TCP) that is one of BASE_DATA, and the part in the robot one of TOOL_DATA. ``what``:
        $tool, $base or $ipo_mode. Raises Unknown."""
        if not isinstance(fdat, Members):
            raise Unknown("programs.krl.no_frame", "it is no frame")
        mode = fdat.get("ipo_frame", fdat.rest)
        mode = "#base" if mode is None else mode
        if isinstance(mode, Lost):
            raise Unknown(mode.told)
        if what == "$ipo_mode":
            return mode
        side = {"$tool": "tool", "$base": "base"}[what]
        if mode == "#tcp":
            side = {"tool": "base", "base": "tool"}[side]
        index = fdat.get(f"{side}_no", fdat.rest)
        if index is None:
            raise lacking(fdat, [f"{side}_no"])
        return self.numbered_frame(side, index)

    def take_fdat(self, line: int) -> None:
        """The frames of FDAT_ACT, as BAS takes them; none where no inline form gave it."""
        fdat = self.values.peek("fdat_act")
        if isinstance(fdat, Lost) and self.take_home(line, fdat.told):
            return
        for name in FDAT if fdat is not None else ():
            try:
                if isinstance(fdat, Lost):
                    raise Unknown(fdat.told)
                value = self.of_fdat(fdat, name)
            except Unknown as unknown:
                value = Lost(unknown.told)
            self.store(line, name, (), value, "fdat_act")

    def take_home(self, line: int, told: Why) -> bool:
        """Whether FDAT_ACT is that of a home, which KUKA's $config.dat has: in base coordinates, in a tool and a
        base that are known by its name. ``told``: why it is not known."""
        home = (
            told[2].get("name", "")
            if isinstance(told, tuple) and told[0] == no_value("")[0]
            else ""
        )
        if not HOME.fullmatch(home):
            return False
        if home not in self.missing:
            self.missing.add(home)
            self.problem(
                line,
                "programs.krl.home_frames",
                "{name} is in no file here; it is taken to be in base coordinates (IPO_FRAME #BASE), in its own tool "
                "and base",
                name=home,
            )
        for name in FRAMES:
            self.values.assign(name, (), Lost(told, f"{name[1:]} of {home}".upper()))
        self.values.assign("$ipo_mode", (), MODES[0])
        return True

    def take_ldat(self, line: int) -> None:
        """How BAS takes LDAT_ACT: turning, and the approximation of an inline form's CONT."""
        ldat = self.values.peek("ldat_act")
        self.turning.take(ldat)
        distance = self.values.peek("ldat_act", ("apo_dist",))
        if distance is None:
            distance = Lost(no_value("ldat_act.apo_dist"))
        if ldat is not None:
            self.store(line, "$apo", ("cdis",), distance)

    def bas(self, line: int, arguments: str) -> None:
        """Follows BAS(what, value)."""
        what, _, value = arguments.partition(",")
        what, value = what.strip().lower(), value.strip()
        if what in ("#cp_params", "#ptp_params", "#frames"):
            self.take_fdat(line)
        if what in ("#cp_params", "#vel_cp"):
            self.set_speed(line, value)
        if what in ("#cp_params", "#cp_dat"):
            self.take_ldat(line)
        if what in ("#tool", "#base"):
            self.set_frame(line, what[1:], value)
        elif what == "#initmov":
            self.turning.reset()
            told = Fact(
                "programs.krl.initmov", "BAS(#INITMOV) sets it to the controller's own value"
            )
            for name in ALL:
                if self.values.peek(name) is not None:
                    words = self.name_frame("as BAS(#INITMOV) sets it".upper())
                    self.values.assign(name, (), Lost(told, words))
            self.values.drop("$ipo_mode")
        elif what == "#ex_base" or what not in BAS_SETS:
            self.problem(
                line,
                "programs.krl.bas",
                "BAS({what}) is not followed; what it may set is not known behind it",
                what=what.upper()[:40],
            )
            self.touch_bas(
                line,
                what,
                ("programs.krl.bas_sets", "BAS({what}) may set it", {"what": what.upper()[:40]}),
            )

    def touch_bas(self, line: int, what: str, told: Why) -> None:
        """Makes unknown what a BAS may set."""
        form = what in ("#cp_params", "#ptp_params", "#frames")
        given = self.values.peek("fdat_act") is not None
        for name in BAS_SETS.get(what, (*ALL, *TURNING)):
            if given or not (form and name in FDAT):
                self.lose(line, name, (), told)

    def frames_now(self) -> list[str]:
        """The words of $TOOL and $BASE; what they are is kept in the program. Raises Unknown where it is not
        known which of both is on the flange."""
        mode = self.values.look("$ipo_mode")
        words: list[str] = []
        for name, kept in (
            ("$tool", self.program.tool_frames),
            ("$base", self.program.base_frames),
        ):
            told, frame = self.frame_words(name)
            if mode == "#tcp":  # the part is on the flange
                side = "fixed in the room" if name == "$tool" else "held by the robot"
                told = f"{told} {side}".strip()
            if frame is not None and told not in kept:
                kept[told] = frame_of(frame)
            words.append(told)
        if mode == "#tcp":
            self.program.held.add(words[1])
        return words

    def frame_words(self, name: str) -> tuple[str, Any]:
        """(words of $TOOL or $BASE, its numbers or None); most motions are in the frame of the one before."""
        version = self.values.versions.get(name, 0)
        if self.in_words.get(name, (None,))[0] != version:
            value = self.values.peek(name)
            told, frame = "", None
            if isinstance(value, Lost):
                told = value.words
            elif isinstance(value, Members):
                told, frame = " ".join(f"{k.upper()} {value[k]:.9g}" for k in FRAME), value
            self.in_words[name] = version, told, frame
        return self.in_words[name][1:]

    def system_function(self, name: str, arguments: Sequence[tuple[Any, Any]]) -> Any:
        """INV_POS, and what the functions behind WITH in an inline form give: SVEL_CP, STOOL2, SBASE and
        their like."""
        if name == "svel_cp":
            return Members({"cp": number(arguments[0][1] if arguments else None)})
        path, data = arguments[-1] if arguments else (None, None)
        if data is None and path is not None:
            data = Lost(no_value(written(*path)))
        if isinstance(data, Lost):
            raise Unknown(data.told)
        if not isinstance(data, Members):
            raise unknown_function(name)
        if name == "inv_pos":
            return components_of(np.linalg.inv(frame_of(data)))
        if name in ("stool2", "sbase", "sipo_mode"):
            return self.of_fdat(data, {"stool2": "$tool", "sbase": "$base"}.get(name, "$ipo_mode"))
        value = data.get({"sapo": "apo_dist", "sori_typ": "ori_typ"}.get(name), data.rest)
        if isinstance(value, Lost):
            raise Unknown(value.told)
        if value is None:
            raise unknown_function(name)
        return Members({"cdis": value}) if name == "sapo" else value
