"""The tables that rules compare, made of the columns of the executed blocks."""
