"""A sheet of charts as SVG, PNG or PDF, by matplotlib's backends of these names.

The same sheet gives the same bytes. Of the SVG, that is tidied: texts stay texts, in the fonts of the
page that holds it; series carry their key as class; nothing in it reaches beyond it, so that it can
stand in an HTML page next to others (matplotlib's own has a style for all elements and the same ids in
every file).
"""

import io
import re
from xml.dom import minidom

from . import figure as figures

FONTS = "Noto Sans, DejaVu Sans, Segoe UI, Helvetica, Arial, sans-serif"  # as report.css has it
NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
SALT = "beltgrinding"
# What an element has without being told, and what nobody asks for.
DEFAULTS = {
    "stroke-linejoin": {"round", "miter"},
    "stroke-linecap": {"butt", "square"},
    "stroke-width": {"1"},
    "stroke-miterlimit": None,
    "stroke-dashoffset": {"0"},
    "text-anchor": {"start"},
    "opacity": {"1"},
}


def svg(sheet, class_=None, label=None, standalone=True):
    """The text of an SVG. ``label``: what it shows, for those who do not see it; ``standalone``: with
    its size and the fonts, for a file of its own. Raises InputError without matplotlib.
    """
    text = io.BytesIO()
    with figures.rules(**{"svg.hashsalt": f"{SALT} {sheet.name}"}):
        figures.figure(sheet).savefig(text, format="svg", dpi=72)
    document = minidom.parseString(text.getvalue())
    root = document.documentElement
    _tidy(root)
    attributes = {
        "xmlns": "http://www.w3.org/2000/svg",
        "xmlns:xlink": "http://www.w3.org/1999/xlink" if "xlink:href" in root.toxml() else None,
        "class": class_,
        "width": f"{sheet.width:g}" if standalone else None,
        "height": f"{sheet.height:g}" if standalone else None,
        "viewBox": f"0 0 {sheet.width:g} {sheet.height:g}",
        "font-family": FONTS if standalone else None,
        "stroke-linejoin": "round",
        "role": "img",
        "aria-label": label,
    }
    for name in list(root.attributes.keys()):
        root.removeAttribute(name)
    for name, value in attributes.items():
        if value is not None:
            root.setAttribute(name, value)
    return root.toxml() + ("\n" if standalone else "")


def picture(sheet, kind="png", dpi=110):
    """The bytes of a file: "png" (with ``dpi`` pixels an inch), "svg" or "pdf". Raises InputError
    without matplotlib.
    """
    if kind == "svg":
        return svg(sheet).encode()
    told = {"png": {"Software": None}, "pdf": {"CreationDate": None}}[kind]
    found = io.BytesIO()
    with figures.rules():
        figures.figure(sheet).savefig(found, format=kind, dpi=dpi, metadata=told)
    return found.getvalue()


def _tidy(element):
    for child in list(element.childNodes):
        if child.nodeType == child.TEXT_NODE and element.tagName == "text":
            continue
        if child.nodeType != child.ELEMENT_NODE or child.tagName in ("metadata", "style"):
            element.removeChild(child)
            continue
        _tidy(child)
        _shorten(child)
        if child.tagName in ("g", "defs") and not child.childNodes:
            element.removeChild(child)
        elif child.tagName == "g" and not child.attributes.length:
            for inner in list(child.childNodes):
                element.insertBefore(inner, child)
            element.removeChild(child)


def _shorten(element):
    """Attributes in place of a style, classes in place of ids of groups, numbers of two decimals."""
    if element.tagName == "g" and element.hasAttribute("id"):
        key = element.getAttribute("id")
        element.removeAttribute("id")
        if not re.fullmatch(r"[\w.]+_\d+", key):  # of matplotlib's own making
            element.setAttribute("class", key)
    if element.hasAttribute("style"):
        style = element.getAttribute("style")
        element.removeAttribute("style")
        for part in filter(None, (part.strip() for part in style.split(";"))):
            name, _, value = (word.strip() for word in part.partition(":"))
            for one, what in _font(value) if name == "font" else ((name, value),):
                if one not in DEFAULTS or DEFAULTS[one] and what not in DEFAULTS[one]:
                    element.setAttribute(one, _rounded(what))
    for name in ("d", "x", "y", "width", "height", "transform"):
        if element.hasAttribute(name):
            value = " ".join(_rounded(element.getAttribute(name)).split())
            element.setAttribute(name, re.sub(r" ?([MLHVCQZz]) ?", r"\1", value))
    if re.match(r"rotate\(-?0[ ,)]", element.getAttribute("transform")):
        element.removeAttribute("transform")


def _font(value):
    """Attributes for the shorthand ``font``; its family is the page's."""
    size = re.search(r"([\d.]+)px", value)
    if size:
        yield "font-size", size[1]
    weight = re.search(r"\b(bold|[1-9]00)\b", value)
    if weight:
        yield "font-weight", weight[1]


def _rounded(text):
    return NUMBER.sub(lambda found: f"{float(found[0]):.2f}".rstrip("0").rstrip("."), text)
