"""Where documents of 0.1.0 look for this view provider."""

from .views.deviation_view import DeviationView  # noqa: F401
