"""The methods that turn a standard-normal vector into a correlated field. A new one is a file here and a line below."""

from rfmpm.random_fields.methods.ar1 import Ar1
from rfmpm.random_fields.methods.cholesky import Cholesky
from rfmpm.random_fields.methods.circulant import Circulant
from rfmpm.random_fields.methods.kronecker import Kronecker
from rfmpm.random_fields.methods.protocol import FieldMethod

METHODS: dict[str, type[FieldMethod]] = {
    "cholesky": Cholesky,
    "kronecker": Kronecker,
    "ar1": Ar1,
    "circulant": Circulant,
}
