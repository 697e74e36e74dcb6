"""Outcomes of earlier runs, in files beside the programs."""
