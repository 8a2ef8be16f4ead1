"""Document objects: data and recompute. Needs FreeCAD, never its window."""
