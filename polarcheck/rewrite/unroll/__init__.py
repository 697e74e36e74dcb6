"""Polar sections as plain moves of X and C, without the mode and without cutter compensation."""
