"""Tool center paths that get G41 or G42 and the contour of the part, and contours written out as tool center paths."""
