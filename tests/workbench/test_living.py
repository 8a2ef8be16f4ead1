"""What has gone is known, whatever FreeCAD raises of it."""

import pytest
import FreeCAD

from beltgrinding.objects.living import GONE, goes_with, living, named

pytestmark = pytest.mark.freecad


def test_an_object_that_has_gone_is_none():
    doc, other = FreeCAD.newDocument("one"), FreeCAD.newDocument("other")
    stays, goes = (doc.addObject("App::FeaturePython", name) for name in ("Stays", "Goes"))
    assert living(stays) is stays and named(doc, "Stays") is stays
    assert goes_with(stays, doc) and not goes_with(stays, other) and living(None) is None
    doc.removeObject("Goes")
    assert living(goes) is None and named(doc, "Goes") is None and goes_with(goes, other)
    FreeCAD.closeDocument("one")
    assert living(stays) is None and named(doc, "Stays") is None and goes_with(stays, other)


@pytest.mark.parametrize("error", GONE)
def test_every_error_of_what_has_gone_is_taken_for_it(error):
    class Deleted:
        @property
        def Document(self):
            raise error("Cannot access attribute 'Document' of deleted object")

        getObject = Document

    assert living(Deleted()) is None and named(Deleted(), "x") is None
    assert goes_with(Deleted(), None)
