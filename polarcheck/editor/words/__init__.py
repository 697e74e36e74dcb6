"""What an editor shows of one word, and offers for the next one: its meaning on this machine, and what is in force."""
