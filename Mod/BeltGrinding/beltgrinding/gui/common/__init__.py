"""What all of the window's parts share: errors, undo steps, icons, runs in the background."""
