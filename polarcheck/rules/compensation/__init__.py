"""Cutter compensation in the polar plane."""
