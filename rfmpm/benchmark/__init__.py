"""Run time against error, measured where the program runs."""
