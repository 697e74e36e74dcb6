"""Fixes of findings, applied to the text without touching anything else, and checked before anything is written."""
