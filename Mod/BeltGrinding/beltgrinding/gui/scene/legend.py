"""The legend of the deviation: a colour bar with numbers and words, laid over the 3D view.

An end of the bar is an arrow where values beyond it have its colour, or may have.
"""

from pivy import coin

from ...engine import core
from ...objects import preferences
from ..common.compat import translate

BAR_STEPS = 120
# In the legend's own coordinates: the view is 2 high, its middle 0.
LEFT, WIDTH, HEIGHT = 0.0, 0.07, 1.3
LABEL_GAP = 0.07  # of half the bar: a line of text
RIGHT = 0.36  # of its ground: room for a line of 14 letters in a view of 600 pixels
LETTERS = 15  # of a line
LINE = 0.085  # from line to line, in a view of 350 pixels
TIP = 0.05  # height of an arrow
COLUMN = RIGHT + 0.08  # from a legend to the next one beside it
PLACE = "BeltGrinding_LegendPlace"  # name of the node that says where it is
# Whether values lie beyond the lower end and the upper one; true, too, where that is not known.
OPEN = (True, True)


def _rgb(packed):
    return tuple((int(packed) >> shift & 255) / 255.0 for shift in (24, 16, 8))


def put_in_column(node, column):
    """Puts a legend, or a group that holds one, beside ``column`` others."""
    search = coin.SoSearchAction()
    search.setName(PLACE)
    search.setSearchingAll(True)
    search.apply(node)
    if search.getPath() is not None:
        place = coin.cast(search.getPath().getTail(), "SoTranslation")
        place.translation = (-0.95 + COLUMN * column, -0.5 * HEIGHT, 0)


def scan_node(lower, upper, limit, out_of_date=False, difference=False, beyond=OPEN):
    """The legend of a scan's heights, or of their difference from the prediction; always in the
    standard colours without steps.
    """
    if difference:
        text = translate("BeltGrinding", "scan - prediction, {}")
    else:
        text = translate("BeltGrinding", "scan, {}")
    return _deviation(lower, upper, limit, out_of_date, 0, None, text, beyond, not difference)


def node(lower, upper, limit, out_of_date=False, bands=0, beyond=OPEN):
    """The legend of the deviation: (mm) tolerance band, and where the ramps end; ``bands``: steps of
    each ramp; ``beyond``: as OPEN.
    """
    text = translate("BeltGrinding", "deviation, {}")
    chosen = preferences.colours()
    return _deviation(lower, upper, limit, out_of_date, bands, chosen, text, beyond, True)


def _deviation(lower, upper, limit, out_of_date, bands, choice, text, beyond, judged):
    values = [-limit + 2 * limit * (k + 0.5) / BAR_STEPS for k in range(BAR_STEPS)]
    unit = preferences.deviation_unit()
    labels = {
        _height(value, limit): f"{value / unit.size:+.{unit.decimals}f}"
        for value in label_values(lower, upper, limit, bands)
    }
    colours = core.colour_scale(lower, upper, limit, values, bands, choice)
    words = ("", "")
    if judged:
        good = translate("BeltGrinding", "good")
        at = _height(0.5 * (lower + upper), limit)
        nearest = min(labels, key=lambda height: abs(height - at))
        if abs(nearest - at) > 0.5 * LABEL_GAP * HEIGHT:
            labels[at] = good
        else:  # no room for a line between
            labels[nearest] += " " + good
        words = (
            translate("BeltGrinding", "cut too deep"),
            translate("BeltGrinding", "too much left"),
        )
    return _legend(colours, labels, text.format(unit.symbol), out_of_date, beyond, words)


def label_values(lower, upper, limit, bands=0):
    """The deviations (mm) that are written: ends, limits, and borders of the bands or halves; none
    so near to another that they would overlap.
    """
    between = (-0.5 * limit, 0.5 * limit)
    if bands:
        steps = [k / bands for k in range(1, bands)]
        between = [upper + t * (limit - upper) for t in steps]
        between += [lower - t * (limit + lower) for t in steps]
    values = []
    for value in (-limit, limit, lower, upper, *between):
        if all(abs(value - other) > LABEL_GAP * limit for other in values):
            values.append(value)
    return values


def uncertainty_node(limit, out_of_date=False):
    """The legend of the deviation's standard deviation, up to ``limit`` mm."""
    colours = core.uncertainty_scale(
        limit, [limit * (k + 0.5) / BAR_STEPS for k in range(BAR_STEPS)]
    )
    unit = preferences.deviation_unit()
    labels = {HEIGHT * k / 4: f"{limit * k / 4 / unit.size:.3g}" for k in range(5)}
    text = translate("BeltGrinding", "uncertainty, {}").format(unit.symbol)
    return _legend(colours, labels, text, out_of_date, (False, True), ("", ""))


def _legend(colours, labels, title, out_of_date, beyond, words):
    """Colour bar with texts by height at the view's left border; not picked, not counted by
    fitAll. ``words``: below the bar and above it.
    """
    outer = coin.SoType.fromName("SoSkipBoundingGroup").createInstance() or coin.SoSeparator()
    group = coin.SoAnnotation()
    outer.addChild(group)
    pick = coin.SoPickStyle()
    pick.style = coin.SoPickStyle.UNPICKABLE
    group.addChild(pick)
    camera = coin.SoOrthographicCamera()
    camera.viewportMapping = coin.SoCamera.LEAVE_ALONE
    camera.position = (0, 0, 1)
    camera.height = 2.0
    group.addChild(camera)
    light = coin.SoLightModel()
    light.model = coin.SoLightModel.BASE_COLOR
    group.addChild(light)
    shift = coin.SoTranslation()
    shift.setName(PLACE)
    shift.translation = (-0.95, -0.5 * HEIGHT, 0)
    group.addChild(shift)
    titles = [*_lines(title), words[1]] if words[1] else _lines(title)
    top = HEIGHT + (TIP if beyond[1] else 0.0)
    bottom = -TIP if beyond[0] else 0.0
    if words[0]:
        bottom -= 0.02 + LINE
    warnings = (
        _lines(translate("BeltGrinding", "out of date: simulate again")) if out_of_date else []
    )
    group.addChild(_panel(bottom, top + 0.13 + LINE * (len(titles) - 1), len(warnings)))
    rgb = [_rgb(c) for c in colours]
    group.addChild(_bar(rgb))
    for there, colour, end, way in zip(beyond, (rgb[0], rgb[-1]), (0.0, HEIGHT), (-TIP, TIP)):
        if there:
            group.addChild(_arrow(colour, end, way))
    text_colour = coin.SoBaseColor()
    text_colour.rgb = (0.0, 0.0, 0.0)
    group.addChild(text_colour)
    font = coin.SoFont()
    font.name = "Sans"
    font.size = 14
    group.addChild(font)
    for height, text in labels.items():
        group.addChild(_label(text, LEFT + WIDTH + 0.02, height))
    for k, line in enumerate(reversed(titles)):
        group.addChild(_label(line, LEFT, top + 0.06 + LINE * k))
    if words[0]:
        group.addChild(_label(words[0], LEFT, bottom))
    if warnings:
        warning = coin.SoBaseColor()
        warning.rgb = (0.7, 0.15, 0.1)
        group.addChild(warning)
    for k, line in enumerate(warnings):
        group.addChild(_label(line, LEFT, bottom - 0.1 - LINE * k))
    return outer


def _lines(text):
    """A text in two lines, if it is long and has a place for that."""
    for mark in (": ", " - "):
        first, found, rest = text.partition(mark)
        if found and len(text) > LETTERS:
            return [first + mark.rstrip(), rest]
    return [text]


def _panel(low, high, lines_below):
    """A light ground about what is between ``low`` and ``high``: FreeCAD's own background may be dark."""
    group = coin.SoSeparator()
    material = coin.SoMaterial()
    material.diffuseColor = (1.0, 1.0, 1.0)
    material.transparency = 0.25
    group.addChild(material)
    low -= 0.06 + (0.045 + LINE * lines_below if lines_below else 0.0)
    right = LEFT + RIGHT
    points = coin.SoCoordinate3()
    corners = [(LEFT - 0.04, low), (right, low), (right, high), (LEFT - 0.04, high)]
    points.point.setValues(0, 4, [(x, y, -0.001) for x, y in corners])
    group.addChild(points)
    face = coin.SoFaceSet()
    face.numVertices = 4
    group.addChild(face)
    return group


def _height(value, limit):
    return HEIGHT * (value + limit) / (2 * limit)


def _label(text, x, y):
    group = coin.SoSeparator()
    move = coin.SoTranslation()
    move.translation = (x, y - 0.012, 0)
    group.addChild(move)
    node = coin.SoText2()
    node.string = text
    group.addChild(node)
    return group


def _arrow(colour, end, way):
    """A tip on the bar: its base at the height ``end``, its point ``way`` from there."""
    group = coin.SoSeparator()
    binding = coin.SoMaterialBinding()  # the mesh behind has a colour a vertex
    binding.value = coin.SoMaterialBinding.OVERALL
    base = coin.SoBaseColor()
    base.rgb = colour
    points = coin.SoCoordinate3()
    corners = [(LEFT, end, 0), (LEFT + WIDTH, end, 0), (LEFT + 0.5 * WIDTH, end + way, 0)]
    points.point.setValues(0, 3, corners)
    face = coin.SoFaceSet()
    face.numVertices = 3
    for node in (binding, base, points, face):
        group.addChild(node)
    return group


def _bar(colours):
    group = coin.SoSeparator()
    material = coin.SoBaseColor()
    material.rgb.setValues(0, BAR_STEPS, colours)
    binding = coin.SoMaterialBinding()
    binding.value = coin.SoMaterialBinding.PER_FACE
    corners, indices = [], []
    for k in range(BAR_STEPS + 1):
        y = HEIGHT * k / BAR_STEPS
        corners += [(LEFT, y, 0), (LEFT + WIDTH, y, 0)]
    for k in range(BAR_STEPS):
        indices += [2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2, -1]
    points = coin.SoCoordinate3()
    points.point.setValues(0, len(corners), corners)
    faces = coin.SoIndexedFaceSet()
    faces.coordIndex.setValues(0, len(indices), indices)
    for node in (material, binding, points, faces):
        group.addChild(node)
    return group
