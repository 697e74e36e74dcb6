"""Bytes to text to one table of words. What is wrong in the text is marked, never raised."""
