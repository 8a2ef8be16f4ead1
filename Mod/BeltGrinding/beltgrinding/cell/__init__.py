"""The cell: paths of the wheel over the work, collisions, a robot's reach, motions and events."""
