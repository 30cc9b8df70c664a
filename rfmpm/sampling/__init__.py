"""Which standard-normal vector `xi` belongs to which realisation, where it is not simply the stream of its index."""

from rfmpm.sampling.designs import LatinHypercube, Sobol
from rfmpm.sampling.directions import Directions
from rfmpm.sampling.markov_chains import MarkovChains
from rfmpm.sampling.protocol import Sampler
from rfmpm.sampling.saltelli import Saltelli
from rfmpm.sampling.stratified_vectors import StratifiedVectors

SAMPLERS = {"latin_hypercube": LatinHypercube, "sobol": Sobol}

__all__ = [
    "SAMPLERS",
    "Directions",
    "LatinHypercube",
    "MarkovChains",
    "Saltelli",
    "Sampler",
    "Sobol",
    "StratifiedVectors",
]
