"""The material point engine: plane strain, explicit, compiled. Knows no statistics, files or MPI."""
