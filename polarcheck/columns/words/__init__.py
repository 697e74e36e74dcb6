"""Words, characters and comments of the text."""
