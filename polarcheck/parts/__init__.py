"""What a job asks for, beside what its program makes of it: contours, and the metal that is left."""
