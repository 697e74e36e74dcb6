"""Entering, leaving, and what may stand between."""
