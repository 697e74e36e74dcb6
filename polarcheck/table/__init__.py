"""The executed program as columns, and the tables that rules compare."""
