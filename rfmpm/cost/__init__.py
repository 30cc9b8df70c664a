"""What a campaign will cost, from short trials; and compiling ahead of time."""

from rfmpm.cost.campaign import estimate
from rfmpm.cost.warmup import warmup

__all__ = ["estimate", "warmup"]
