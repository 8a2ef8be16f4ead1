"""Widgets that panels and docks are made of."""
