"""Custom macro and program flow."""
