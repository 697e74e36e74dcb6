"""From the tables of a program to findings: rules found and run, messages, what was not evaluated."""
