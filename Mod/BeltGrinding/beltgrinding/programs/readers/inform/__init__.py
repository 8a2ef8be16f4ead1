"""Yaskawa INFORM."""
