"""How objects get their view providers, which stand in a layer above: its factory is put in here."""

factory = None  # (view object, name of the class): set by the package itself


def attach(view_object, name):
    """Gives a view object the view provider of that name."""
    factory(view_object, name)
