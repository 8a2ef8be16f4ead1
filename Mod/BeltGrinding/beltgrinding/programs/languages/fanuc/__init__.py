"""Fanuc TP."""
