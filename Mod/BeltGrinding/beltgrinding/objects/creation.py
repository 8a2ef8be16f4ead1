"""How objects are added to a document: whole, or not at all."""

from .job_data import child
from .properties import set_by_name


def make_child(job, proxy, name, label, properties):
    """The job's child of a kind, made where it is missing, with properties set."""
    found = child(job, proxy)
    if found is not None:
        set_by_name(found, properties)
        return found
    found = job.Document.addObject("App::FeaturePython", name)
    with removed_on_error(found):
        proxy(found)
        called(found, label)
        set_by_name(found, properties)
        job.addObject(found)
    return found


def called(obj, label):
    """Gives a new object the label that it has in the user's language; English ones are FreeCAD's, numbered
    where there are several."""
    if obj.Label.rstrip("0123456789") != label:
        obj.Label = label
    return obj


class removed_on_error:
    """Removes a new object from its document if the block fails."""

    def __init__(self, obj):
        self.document, self.name = obj.Document, obj.Name

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind is not None and self.document.getObject(self.name) is not None:
            self.document.removeObject(self.name)
        return False
