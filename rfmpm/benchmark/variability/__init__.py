"""The random-field study: the short slope over the variation, the vertical scale and the anisotropy of its strength."""
