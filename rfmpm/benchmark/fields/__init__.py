"""Run time against covariance error of the field methods, and of other packages where they are installed."""
