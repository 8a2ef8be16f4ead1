"""Charts: what is drawn as plain data, round values for axes, and the drawing as SVG, PNG or PDF."""
