"""Estimators against their reference: bias, coverage of the intervals, and error over cost."""
