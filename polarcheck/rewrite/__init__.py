"""Programs rewritten and compared: fixes, feeds, convert, compensate, roll, unroll, compare, certify."""
