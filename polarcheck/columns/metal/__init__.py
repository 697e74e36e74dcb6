"""Metal: the bar, what mills take off, and the part that they leave."""
