"""The pieces that a report's sections are made of."""

from .markup import e


def section(title, *children, **attributes):
    """A section with its heading; nothing without any child."""
    if all(child is None for child in children):
        return None
    return e("section", e("h2", title), *children, **attributes)


def facts(pairs, class_="facts"):
    """A table of labels and values."""
    body = [e("tr", e("th", label, scope="row"), e("td", value)) for label, value in pairs]
    return e("table", e("tbody", body), class_=class_)


def table(heads, rows, class_="list"):
    """A table; ``heads``: (text, class of its column's cells or '')."""
    body = [
        e("tr", [e("td", cell, class_=kind or None) for cell, (_, kind) in zip(row, heads)])
        for row in rows
    ]
    head = e("tr", [e("th", text, class_=kind or None) for text, kind in heads])
    return e("table", e("thead", head), e("tbody", body), class_=class_)
