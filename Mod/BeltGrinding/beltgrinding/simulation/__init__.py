"""Runs of jobs, what they give, and whether their settings are fine enough."""
