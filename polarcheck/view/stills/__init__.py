"""Pictures for documents: PNG and SVG, of a size that fits on a page of A4."""
