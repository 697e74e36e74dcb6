"""Pictures of what a program does: data for a page, and small views for a terminal. Nothing is printed here."""
