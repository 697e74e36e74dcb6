"""The exit codes; where several apply, the highest counts."""

CLEAN = 0
#: Findings at or above --fail-on.
FINDINGS = 1
#: Usage, an unreadable file, a broken configuration, a report that cannot be written.
COULD_NOT_RUN = 2
#: Of polarcheck itself.
BUG = 3
INTERRUPTED = 130
