"""Frictional soil against what was published: a pile of bars, granular columns."""
