"""What a person sees: commands, panels, view providers. Needs FreeCAD's window."""
