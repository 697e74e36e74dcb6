"""The metal, and what is almost right."""
