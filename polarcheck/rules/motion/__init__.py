"""Arcs, words and travel."""
