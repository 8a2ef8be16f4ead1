"""When to change the belt over a batch, and how feed or force follow its wear."""

from pathlib import Path

from . import background, figures, outputs


def add(commands):
    """Adds the command to the parser's ``commands``."""
    belt = commands.add_parser(
        "belt-plan",
        help="find when to change the belt over a batch, and how feed or force follow its wear (docs/belt-plan.md)",
        description="The job is simulated with a fresh belt. Each further part of the batch is ground slower, or pressed "
        "harder, so that it loses as much; the cheapest moments to change the belt follow from the costs.",
    )
    belt.add_argument("job", help="job.json, with a law that has a wear")
    belt.add_argument("-o", "--output", required=True, help="folder for JSON, CSV and chart")
    belt.add_argument("--parts", type=int, required=True, metavar="N", help="of the batch")
    for name, text in (
        ("--belt-cost", "price of a belt"),
        ("--change-min", "time of changing it, minutes"),
        ("--minute-cost", "what a minute of the cell costs"),
    ):
        belt.add_argument(name, type=float, required=True, metavar="X", help=text)
    belt.add_argument(
        "--follow",
        choices=("feed", "force", "both"),
        default="feed",
        help="what follows the wear; both: the force first (default feed)",
    )
    belt.add_argument(
        "--feed-min", type=float, default=3.0, metavar="MM_S", help="least feed, mm/s (default 3)"
    )
    belt.add_argument(
        "--force-max", type=float, default=0.0, metavar="N", help="greatest force, for force, both"
    )
    belt.add_argument(
        "--pause-s",
        type=float,
        default=0.0,
        metavar="S",
        help="for which the belt runs free between two parts, and gives back loading (default 0)",
    )
    belt.add_argument(
        "--dress-every",
        type=int,
        default=0,
        metavar="N",
        help="parts after which the belt is dressed (default 0: never)",
    )
    belt.add_argument(
        "--dress-s", type=float, default=0.0, metavar="S", help="time of a dressing (default 0)"
    )
    belt.add_argument("-q", "--quiet", action="store_true", help="no progress, no summary")
    outputs.add(belt)
    figures.add(belt)
    belt.set_defaults(do=_belt_plan)


def _belt_plan(arguments):
    from ..engine import InputError
    from ..job import inputs, law as laws, load as jobs
    from ..planning import belt_loading, belt_plan

    if arguments.follow != "feed" and arguments.force_max <= 0.0:
        raise InputError(
            "cli.force_max", "--follow {follow} needs --force-max", follow=arguments.follow
        )
    out = Path(arguments.output)
    job = jobs.load(arguments.job)
    outputs.check(
        arguments, [out / name for name in belt_plan.FILES], [arguments.job, *inputs.files(job)]
    )
    costs = belt_plan.Costs(arguments.belt_cost, 60.0 * arguments.change_min, arguments.minute_cost)
    between = belt_loading.Between(arguments.pause_s, arguments.dress_every, arguments.dress_s)
    belt_loading.check(between, laws.engine_wear(job["law"]))

    def work(context):
        part, _ = belt_plan.part_of(
            job, arguments.feed_min, arguments.force_max, arguments.follow, context
        )
        return belt_plan.plan(job, part, costs, arguments.parts, context, between)

    found = background.run(work, arguments.quiet)
    data = belt_plan.summary(found, costs)
    belt_plan.write(found, costs, out)
    if arguments.json or not arguments.quiet:
        figures.tell(arguments, data, _text(data))


def _text(data):
    belts = ", ".join(map(str, data["parts_per_belt"][:12]))
    if len(data["parts_per_belt"]) > 12:
        belts += ", ..."
    beyond = data["parts_beyond_measured_wear"]
    return (
        f"{data['parts']} parts, {data['new_belts']} new belts; parts per belt: {belts} "
        f"(a fresh one can do {data['life_parts']})\n"
        f"cost {data['cost']:.2f}, {data['cost_per_part']:.3f} a part, {data['seconds'] / 3600:.2f} h; with every belt "
        f"used as long as it can: {data['cost_until_worn_out']:.2f}"
        + (
            f"\n{beyond} parts are ground by belts that have done more than their wear was measured for"
            if beyond
            else ""
        )
    )
