"""Readers of robot languages: one module or one package each, with ``read(path) -> Program``."""
