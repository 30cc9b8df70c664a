"""Random fields: a correlation, a marginal distribution and a method turn a standard-normal vector into strength."""
