"""On the path of a Python, the first segment that worker $TORN writes lacks its last byte afterwards."""

import os

from rfmpm import results

real_write = results.write_rows
torn = []


def write_rows(folder, stem, *rest):
    path = real_write(folder, stem, *rest)
    if int(stem.split("-")[0]) == int(os.environ["TORN"]) and not torn:
        torn.append(path)
        path.write_bytes(path.read_bytes()[:-1])
    return path


results.write_rows = write_rows
