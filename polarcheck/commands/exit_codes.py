"""The exit codes; where several apply, the highest counts. Those of signals stand in `ending`."""

CLEAN = 0
#: Findings at or above --fail-on.
FINDINGS = 1
#: Usage, a file that is unreadable or too hard, a broken configuration, a report that cannot be written.
COULD_NOT_RUN = 2
#: Of polarcheck itself.
BUG = 3
