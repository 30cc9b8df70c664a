"""The methods that turn a standard-normal vector into a correlated field. A new one is a file here and a line below."""

from rfmpm.random_fields.methods.cholesky import Cholesky
from rfmpm.random_fields.methods.protocol import FieldMethod

METHODS: dict[str, type[FieldMethod]] = {"cholesky": Cholesky}
