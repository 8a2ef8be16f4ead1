"""A job as plain data: loaded, checked, and turned into what the engine takes."""
