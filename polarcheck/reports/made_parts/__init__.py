"""The part that a program makes, in words, and how it differs from the part of the job."""
