"""The correlations a study can name. A new one is a file here and a line in the table."""

from rfmpm.random_fields.correlation.anisotropy import Anisotropy
from rfmpm.random_fields.correlation.cosine_exponential import CosineExponential
from rfmpm.random_fields.correlation.gaussian import Gaussian
from rfmpm.random_fields.correlation.markov_ellipsoidal import MarkovEllipsoidal
from rfmpm.random_fields.correlation.markov_separable import MarkovSeparable
from rfmpm.random_fields.correlation.matern import Matern
from rfmpm.random_fields.correlation.second_order_markov import SecondOrderMarkov
from rfmpm.random_fields.correlation.spherical import Spherical

CORRELATIONS: dict[str, type[Anisotropy]] = {
    "markov_separable": MarkovSeparable,
    "markov_ellipsoidal": MarkovEllipsoidal,
    "gaussian": Gaussian,
    "spherical": Spherical,
    "matern": Matern,
    "second_order_markov": SecondOrderMarkov,
    "cosine_exponential": CosineExponential,
}
