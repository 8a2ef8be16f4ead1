"""PolyScope programs (.urp) of Universal Robots."""
