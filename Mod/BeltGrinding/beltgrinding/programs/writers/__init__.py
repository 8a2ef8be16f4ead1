"""Writers of new robot programs: one module a language."""
