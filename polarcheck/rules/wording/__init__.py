"""The words and numbers of findings about one place, which the templates of messages name."""
