"""Reads Heidenhain conversational programs (Klartext)."""
