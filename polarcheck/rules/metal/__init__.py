"""Metal that comes out otherwise: contours that are almost right, and cuts that hit what should stand."""
