"""Stress test of the engine: sweeps far beyond what a campaign asks for, with a verdict for every run."""
