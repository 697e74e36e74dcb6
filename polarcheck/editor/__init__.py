"""The language server: shows findings and other results of a check in an editor while a program is written."""
