"""Options and words of the search for wheel, direction and belt angle (planning/search.py)."""

import math

from .messages import print_text

NONE = "none"


def add(parser):
    """Gives a command the options of the search."""
    parser.add_argument(
        "--budget",
        metavar="S",
        help="seconds for the search of direction, belt angle and wheel (120); none: as long as it pays; 0: no search",
    )
    parser.add_argument(
        "--wheels",
        metavar="WHEELS",
        help="wheels that may be taken: own, any, or sizes in mm as 20x15,10x8c40 (radius x width, c: with a crown of "
        "that radius); default: any for a part's file; own for a job, with what other wheels would bring",
    )
    parser.add_argument(
        "--processes",
        type=int,
        default=0,
        metavar="N",
        help="that search side by side; 0: one a core",
    )


def budget(arguments):
    """Seconds; inf: as long as it pays. Raises InputError."""
    from ..engine import InputError
    from ..planning import search

    if arguments.processes < 0:
        raise InputError(
            "cli.processes",
            "--processes {given}: give a number from 0, which is one a core",
            given=arguments.processes,
        )
    if arguments.budget is None:
        return search.BUDGET_S
    if arguments.budget == NONE:
        return search.UNTIL_IT_PAYS
    try:
        seconds = float(arguments.budget)
    except ValueError:
        seconds = math.nan
    if not 0.0 <= seconds < math.inf:
        raise InputError(
            "cli.budget",
            "--budget {given}: give seconds from 0, or {none}",
            given=arguments.budget,
            none=NONE,
        )
    return seconds


def wheels(arguments):
    """Checks ``--wheels``, before anything is read. Raises InputError."""
    from ..planning import wheels as series

    if arguments.wheels not in (None, series.OWN, series.ANY):
        series.given(arguments.wheels)


def search(arguments, job, fixed, of_a_job):
    """The ``planning.search.Search`` that is wanted, or None. ``fixed``: settings of the raster that are given."""
    from ..planning import search as searches, wheels as series

    seconds = budget(arguments)
    if not seconds:
        return None
    own = series.own(job)
    known = [*series.series(own), *series.of_presets()]
    wanted = arguments.wheels or (series.OWN if of_a_job else series.ANY)
    taken, further = [], []
    if wanted == series.ANY:
        taken = known
    elif wanted == series.OWN:
        further = known
    else:
        taken = series.given(wanted)
        further = [one for one in known if one not in taken]
    return searches.Search(
        budget_s=seconds,
        wheels=series.mounted(job, taken),
        further=series.mounted(job, further),
        fixed=tuple(sorted(fixed)),
        workers=arguments.processes,
    )


class Watched:
    """Progress of a search; the first Ctrl-C takes the best so far."""

    def __init__(self, told):
        self._told, self.searching, self.enough = told, False, False

    def told(self, one):
        """Hands on what ``grinding.grind`` tells."""
        self.searching = "change" in one
        if self._told is not None:
            self._told(one)

    def interrupted(self):
        """Whether Ctrl-C is taken for 'enough'."""
        if self.enough or not self.searching:
            return False
        self.enough = True
        print_text(
            "\nenough: the best so far is planned and written; Ctrl-C once more ends it without"
        )
        return True


def tell(arguments, found):
    """Prints what a ``grinding.Ground`` says of its search, if there was one."""
    from ..base.messages import sentence
    from ..planning import wheels as series

    report = found.search
    if report is None or arguments.quiet:
        return
    through = "" if report["through"] else "; not all was tried in that time"
    print_text(
        f"searched {report['seconds']:.0f} s, {len(report['tried'])} plans of passes{through}; the job's wheel gets to "
        f"{100 * report['reachable']:.1f} % of the area, some wheel to {100 * report['reachable_by_any']:.1f} %"
    )
    told = sorted(
        (one for one in report["wheels"] if one["gain"] is not None), key=lambda one: -one["gain"]
    )
    for one in told:
        name = sentence(series.name(one["wheel"]), arguments.messages.language)
        print_text(
            f"  {name}: {100 * one['gain']:+.1f} points in tolerance by rough plans, gets to "
            f"{100 * one['reachable']:.1f} %"
        )
