"""Which files beside a program its reader looks at: the poses depend on them as on the program itself."""

from pathlib import Path


def side_files(path):
    """Sorted paths of the files in the folder of the program ``path`` that reading it takes values, data or
    routines from, NAME.values.json aside: of KRL its data list and what is seen of others (``$config.dat`` among
    them), of RAPID the other modules and the .pgf that lists them, of VAL3 the application. None where there is
    no such folder.
    """
    path = Path(path)
    of_language = _OF.get(path.suffix.lower())
    if of_language is None:
        return []
    try:
        return sorted({p for p in of_language(path) if p != path})
    except (OSError, ValueError):  # a name that no file can have
        return []


def _krl(path):
    from .krl import data_lists

    own = data_lists.own(path)
    return [*([own] if own else []), *(one for one, _ in data_lists.others(path)[0])]


def _rapid(path):
    from .rapid import modules

    return modules.looked_at(path)


def _val3(path):
    from .val3.project import Project

    project = Project(path)  # all of the folder is one application
    return [p for suffix in (".pgx", ".dtx", ".pjx") for p in project.of_suffix(suffix)]


_OF = {".src": _krl, ".pgx": _val3, ".dtx": _val3}
_OF.update(dict.fromkeys((".mod", ".modx", ".prg", ".sys"), _rapid))
