"""Changes written back into robot programs: one module a family of languages."""
