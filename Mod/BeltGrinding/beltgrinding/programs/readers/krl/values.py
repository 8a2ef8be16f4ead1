"""What a KRL program knows of its variables."""


class Values(dict):
    """Values by (name, indices); what is forgotten is forgotten by name."""

    def __init__(self):
        super().__init__()
        self._indices = {}  # of the names that have any: {name: {indices: None}}

    def __setitem__(self, key, value):
        super().__setitem__(key, value)
        if key[1]:
            self._indices.setdefault(key[0], {})[key[1]] = None

    def forget(self, name):
        """Whatever indices it has."""
        self.pop((name, ()), None)
        for indices in self._indices.pop(name, ()):
            self.pop((name, indices), None)
