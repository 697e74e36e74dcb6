"""What writes the generated pages of docs/: a module per kind of page, called by make.py."""
