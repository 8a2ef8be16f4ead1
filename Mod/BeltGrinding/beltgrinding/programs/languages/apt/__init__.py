"""APT cutter location files."""
