"""The passes: what is drawn, from the tables and poses that the simulation leaves behind."""
