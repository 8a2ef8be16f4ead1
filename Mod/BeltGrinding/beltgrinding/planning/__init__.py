"""Plans: the feeds with which a job's programs keep the tolerance. What macros call is ``plan``."""

from .rounds import Plan, plan

__all__ = ["Plan", "plan"]
