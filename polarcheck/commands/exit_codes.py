"""The exit codes; if several apply, the highest counts. Those of signals are in `ending`."""

CLEAN = 0
#: Findings at or above --fail-on.
FINDINGS = 1
#: Usage, a file that is unreadable or too hard, a broken configuration, a report that cannot be written.
COULD_NOT_RUN = 2
#: An error of polarcheck itself.
BUG = 3
