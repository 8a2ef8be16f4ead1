"""Stäubli VAL3."""
