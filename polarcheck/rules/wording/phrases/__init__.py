"""Words for messages about one place, in the program's own units: a module for each group of rules, and `common`."""
