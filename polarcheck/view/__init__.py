"""Pictures of the paths of a program: data for a page, and small views for a terminal. Nothing here prints."""
