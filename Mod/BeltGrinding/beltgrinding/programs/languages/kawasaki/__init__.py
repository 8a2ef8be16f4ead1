"""Reads Kawasaki AS."""
