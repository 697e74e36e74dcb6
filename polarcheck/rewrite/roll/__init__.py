"""Plain moves of X and C, as a CAM without the polar mode writes them, as polar sections of lines and arcs."""
