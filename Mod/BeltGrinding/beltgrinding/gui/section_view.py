"""Where documents of 0.1.0 look for this view provider."""

from .views.section_view import SectionView  # noqa: F401
