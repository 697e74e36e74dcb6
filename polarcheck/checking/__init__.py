"""From rules to findings: the engine, the verdict, what was not evaluated, suppressed findings."""
