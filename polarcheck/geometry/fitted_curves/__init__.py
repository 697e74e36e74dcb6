"""Lines and arcs within a tolerance of the way that X and C run at even rates outside the polar mode."""
