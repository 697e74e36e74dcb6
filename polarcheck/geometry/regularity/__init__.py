"""Closed contours that repeat themselves: how regular a ring is, and where its corners should be."""
