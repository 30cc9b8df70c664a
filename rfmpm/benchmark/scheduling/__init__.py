"""Measures how well a campaign keeps its workers busy, and what stopping it early would do to its answer."""
