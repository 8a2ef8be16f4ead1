"""Where documents of 0.1.0 look for this view provider."""

from .views.ground_mesh_view import GroundMeshView  # noqa: F401
