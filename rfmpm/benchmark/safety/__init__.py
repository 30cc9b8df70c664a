"""Factors of safety: how right they are, and what they say of the slopes that fail."""
