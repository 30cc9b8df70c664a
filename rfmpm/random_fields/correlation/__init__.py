"""The correlations a study can name. A new one is a file here and a line in the table."""

from rfmpm.random_fields.correlation.anisotropy import Anisotropy
from rfmpm.random_fields.correlation.gaussian import Gaussian
from rfmpm.random_fields.correlation.markov_ellipsoidal import MarkovEllipsoidal
from rfmpm.random_fields.correlation.markov_separable import MarkovSeparable

CORRELATIONS: dict[str, type[Anisotropy]] = {
    "markov_separable": MarkovSeparable,
    "markov_ellipsoidal": MarkovEllipsoidal,
    "gaussian": Gaussian,
}
