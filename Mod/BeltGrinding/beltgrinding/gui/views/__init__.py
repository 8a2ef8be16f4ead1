"""View providers. Documents of 0.1.0 name the classes as attributes of this package."""

from .providers import *  # noqa: F403
