"""The body before it moves: its outline, and the material points that fill it."""

from rfmpm.mpm.geometry.body import Body, body
from rfmpm.mpm.geometry.convex import centroid, clip, fill
from rfmpm.mpm.geometry.filling import Filling, fill_body

__all__ = ["Body", "Filling", "body", "centroid", "clip", "fill", "fill_body"]
