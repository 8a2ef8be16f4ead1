"""Rounds of a plan, and passes that are tried, as tables: a header, then a line each as it comes."""

from .messages import print_text

ROUNDS = ("round", "in tol. %", "too much %", "too deep %", "rms mm", "time s", "")
PASSES = (
    "passes",
    "wheel mm",
    "along",
    "belt deg",
    "apart mm",
    "run-out mm",
    "times",
    "poses",
    "in tol. %",
    "",
)
WIDTHS = {ROUNDS: (5, 9, 10, 10, 6, 7, 0), PASSES: (6, 13, 17, 8, 8, 10, 5, 6, 9, 0)}


class Table:
    """``told(dict)``: prints what ``planning.rounds.plan`` and ``planning.grinding.grind`` tell; a header wherever the
    kind changes."""

    def __init__(self):
        self.head, self.number = None, 0

    def told(self, one):
        head, row = (PASSES, _passes(one)) if "change" in one else (ROUNDS, _round(one))
        if head is not self.head:
            self.head, self.number = head, 0
            print_text(_line(head, head))
        simulated = "from_file" not in one
        self.number += simulated
        print_text(_line(head, (str(self.number) if simulated else "file", *row)))


def _line(head, texts):
    return "  ".join(text.rjust(width) for text, width in zip(texts, WIDTHS[head])).rstrip()


def _passes(one):
    words = [] if one["better"] else ["not better"]
    words += ["full plan"] if one["change"] == "full" else []
    words += [f"then {_along(k)}, belt {k['belt_angle_deg']:g}" for k in one["further_passes"]]
    return (
        wheel(one["wheel"]),
        _along(one),
        f"{one['belt_angle_deg']:.1f}",
        f"{one['step_over_mm']:.2f}",
        f"{one['run_out_mm']:.2f}",
        str(one["repeats"]),
        str(one["poses"]),
        f"{100 * one['in_tolerance']:.1f}",
        ", ".join(words),
    )


def wheel(one):
    crown = f"c{one['crown_radius_mm']:g}" if one["crown_radius_mm"] else ""
    return f"{one['radius_mm']:g} x {one['width_mm']:g}{crown}"


def _along(one):
    if one["along"] != "direction":
        return one["along"]
    return " ".join(f"{value:.2f}" for value in one["direction"])


def _round(one):
    words = ["read again, at half the spacing"] if "from_file" in one else []
    words += [f"in {one['levels']} levels"] if "levels" in one else []
    words += ["coarse"] if one.get("resolution") == "coarse" else []
    return (
        f"{100 * one['in_tolerance']:.1f}",
        f"{100 * one['above']:.1f}",
        f"{100 * one['below']:.1f}",
        f"{one['rms_mm']:.3f}",
        f"{one['process_time_s']:.1f}",
        ", ".join(words),
    )
