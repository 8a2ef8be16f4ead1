"""View provider of the deviation: vertex colours that survive reopening, and a legend."""

from pivy import coin

from .. import core

BAR_STEPS = 120
# In the legend's own coordinates: the view is 2 high, its middle 0.
LEFT, WIDTH, HEIGHT = 0.0, 0.07, 1.3


class DeviationView:
    """Proxy of the view provider."""

    def __init__(self, view):
        view.Proxy = self
        view.Coloring = True

    def attach(self, view):
        self.view = view
        self.legend = coin.SoSwitch()
        view.RootNode.addChild(self.legend)
        self.update_legend()

    def finishRestoring(self):
        # 0.20 forgets the colours on reopening, although the property is still set.
        self.view.Coloring = False
        self.view.Coloring = True
        self.update_legend()

    def updateData(self, obj, name):
        if name == "VertexColors" and getattr(self, "view", None):
            self.view.Coloring = False
            self.view.Coloring = True
        if name in ("ToleranceLower", "ToleranceUpper", "ColourLimit"):
            self.update_legend()

    def onChanged(self, view, name):
        if name == "Visibility" and hasattr(self, "legend"):
            self.legend.whichChild = -3 if view.Visibility else -1

    def update_legend(self):
        obj = self.view.Object
        if not hasattr(obj, "ColourLimit") or obj.ColourLimit <= 0:
            return
        self.legend.removeAllChildren()
        self.legend.addChild(_legend(obj.ToleranceLower, obj.ToleranceUpper, obj.ColourLimit))
        self.legend.whichChild = -3 if self.view.Visibility else -1

    def dumps(self):
        return None

    def loads(self, state):
        return None

    __getstate__ = dumps

    def __setstate__(self, state):
        return None


def _rgb(packed):
    return tuple((int(packed) >> shift & 255) / 255.0 for shift in (24, 16, 8))


def _legend(lower, upper, limit):
    """Colour bar with numbers at the view's left border; not picked, not counted by fitAll."""
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
    shift.translation = (-0.95, -0.5 * HEIGHT, 0)
    group.addChild(shift)
    group.addChild(_bar(lower, upper, limit))
    text_colour = coin.SoBaseColor()
    text_colour.rgb = (0.0, 0.0, 0.0)
    group.addChild(text_colour)
    font = coin.SoFont()
    font.name = "Sans"
    font.size = 14
    group.addChild(font)
    for value in (-limit, -0.5 * limit, lower, upper, 0.5 * limit, limit):
        group.addChild(_label(f"{value:+.3f}", LEFT + WIDTH + 0.02, _height(value, limit)))
    group.addChild(_label("deviation, mm", LEFT, HEIGHT + 0.06))
    return outer


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


def _bar(lower, upper, limit):
    group = coin.SoSeparator()
    values = [-limit + 2 * limit * (k + 0.5) / BAR_STEPS for k in range(BAR_STEPS)]
    colours = [_rgb(c) for c in core.colour_scale(lower, upper, limit, values)]
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
