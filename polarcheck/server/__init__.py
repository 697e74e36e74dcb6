"""The language server: what a check finds and knows, shown by an editor while a program is written."""
