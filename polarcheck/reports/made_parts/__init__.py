"""What a program makes, and whether it is the part asked for."""
