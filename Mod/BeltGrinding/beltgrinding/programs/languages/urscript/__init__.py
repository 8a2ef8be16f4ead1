"""URScript of Universal Robots."""
