"""Contours: their loops, passes and ramps, and the faults in their shape."""
