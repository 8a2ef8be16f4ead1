"""One contact, and surrogates learnt from many."""

import sys

from . import background, figures, outputs


def add(commands):
    """Adds the commands to the parser's ``commands``."""
    contact = commands.add_parser("contact", help="press the wheel on a workpiece, at one place")
    contact.add_argument("contact", help="contact.json; or a job.json, with --pose")
    contact.add_argument("--pose", type=int, help="pose of the job's program, from 1")
    contact.add_argument("--program", type=int, default=1, help="program of the job, from 1")
    contact.add_argument("-o", "--output", help="CSV for the pressure of every cell")
    contact.add_argument("--reference", choices=("ccx",), help="solve it by CalculiX as well")
    contact.add_argument("--keep", help="folder for CalculiX's deck and results")
    outputs.add(contact)
    figures.add(contact)
    contact.set_defaults(do=_contact)
    learn = commands.add_parser(
        "surrogate", help="train a surrogate of the contact on a database of solved contacts"
    )
    learn.add_argument("contact", nargs="?", help="contact.json: the wheel, the force, the cells")
    learn.add_argument("-o", "--output", required=True, help="file for the surrogate (.npz)")
    learn.add_argument("--contacts", type=int, default=2000, help="to solve (default 2000)")
    learn.add_argument("--source", choices=("wheel_rim", "ccx"), default="wheel_rim")
    learn.add_argument("--seed", type=int, default=1, help="of the random contacts (default 1)")
    learn.add_argument("--database", help="file that keeps the database (.npz)")
    learn.add_argument("--train-on", help="a database of your own in place of a contact.json")
    outputs.add(learn)
    figures.add(learn)
    learn.set_defaults(do=_surrogate)


def _contact(arguments):
    from ..contact import single_contact as contact
    from ..job import load as job

    outputs.check(arguments, [arguments.output], [arguments.contact])
    if arguments.pose is None:
        given = contact.load(arguments.contact)
        result = contact.run(given)
    else:
        given = job.load(arguments.contact)
        result = background.run(
            lambda context: contact.at_pose(given, arguments.pose, arguments.program, context),
            quiet=True,
        )
    found, truth = contact.summary(result), None
    if arguments.reference:
        from ..contact import finite_elements as reference

        truth = reference.solve(result, contact.rim(given), arguments.keep)
        found.update(reference.compare(result, truth))
    if arguments.output:
        contact.write_csv(result, arguments.output, truth)
    figures.tell(arguments, found)


def _surrogate(arguments):
    from ..contact import single_contact as contact, surrogate
    from ..engine import InputError
    from ..job import surrogate_file

    if (arguments.contact is None) == (arguments.train_on is None):
        raise InputError(
            "cli.contact_or_database", "give either a contact.json or --train-on with a database"
        )

    written = [arguments.output, arguments.database]
    outputs.check(arguments, written, [arguments.contact, arguments.train_on])

    def tell(done, count):
        print(f"\r{done} of {count} contacts", end="", file=sys.stderr, flush=True)

    if arguments.train_on:
        database = surrogate_file.load_database(arguments.train_on)
    else:
        database = surrogate.make_database(
            contact.load(arguments.contact),
            arguments.contacts,
            arguments.source,
            arguments.seed,
            tell if sys.stderr.isatty() else None,
        )
        if arguments.database:
            surrogate_file.save_database(database, arguments.database)
    trained, report = surrogate.train(database, arguments.seed)
    surrogate_file.save(trained, arguments.output)
    figures.tell(arguments, report)
