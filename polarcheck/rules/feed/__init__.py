"""F, and the speed of the C axis."""
