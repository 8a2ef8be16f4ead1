"""Pictures of a report with marks on them, as SVG."""

from ..charts.model import INK
from .markup import element


def _svg(width, height, *children, **attributes):
    return element(
        "svg",
        *children,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width} {height}",
        font_family="sans-serif",
        font_size=12,
        fill=INK,
        role="img",
        **attributes,
    )


def marked(view, uri, marks, alt):
    """A picture with numbered marks. ``marks``: (number, column, row) in pixels; ``view``: its
    ``picture.View``; ``uri``: its data.
    """
    rows, columns = view.depth.shape
    size = columns / 45.0
    drawn = [element("image", href=uri, x=0, y=0, width=columns, height=rows)]
    labels = _placed(marks, columns, rows, size)
    for (_, x, y), (at, up) in zip(marks, labels):  # lines below all rings and labels
        pen = {"fill": "none", "stroke_linecap": "round"}
        line = f"M{x:.1f} {y:.1f}L{at:.1f} {up:.1f}"
        drawn.append(element("path", d=line, stroke="white", stroke_width=size / 4, **pen))
        drawn.append(element("path", d=line, stroke=INK, stroke_width=size / 10, **pen))
    for number, x, y in marks:
        drawn.append(element("circle", cx=x, cy=y, r=size / 4.2, fill=INK, stroke="white"))
    for (number, *_), (at, up) in zip(marks, labels):
        drawn.append(
            element("circle", cx=at, cy=up, r=0.85 * size, fill=INK, stroke="white", stroke_width=2)
        )
        drawn.append(
            element(
                "text",
                number,
                x=at,
                y=up + 0.37 * size,
                text_anchor="middle",
                fill="white",
                font_size=1.1 * size,
                font_weight="bold",
            )
        )
    return _svg(columns, rows, drawn, class_="picture", aria_label=alt)


def ringed(view, uri, x, y, alt):
    """A picture with a ring around the place (column, row)."""
    rows, columns = view.depth.shape
    size = columns / 20.0
    rings = [
        element("circle", cx=x, cy=y, r=size, fill="none", stroke=colour, stroke_width=size / thin)
        for colour, thin in (("white", 3.2), (INK, 8.0))
    ]
    image = element("image", href=uri, x=0, y=0, width=columns, height=rows)
    return _svg(columns, rows, image, rings, class_="picture", aria_label=alt)


def _placed(marks, columns, rows, size):
    """Where the numbers stand: at the nearer border, one below the other, in their marks' order."""
    placed = {}
    for border, side in ((1.4 * size, False), (columns - 1.4 * size, True)):
        own = sorted((m for m in marks if (m[1] > 0.5 * columns) == side), key=lambda m: m[2])
        step, low = 2.1 * size, 1.4 * size
        for k, (number, _, y) in enumerate(own):
            room = rows - 1.4 * size - step * (len(own) - 1 - k)  # for those that follow
            low = min(max(low, y), room)
            placed[number] = (border, low)
            low += step
    return [placed[number] for number, *_ in marks]
