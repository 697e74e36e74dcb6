"""What a program makes, in words, and how that differs from the part that the job asks for."""
