"""Fixes of findings: edits that change nothing else, checked before anything is written."""
