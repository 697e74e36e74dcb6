"""Paths on the polar plane run by X and C that both move evenly, as they do outside of the polar mode."""
