"""How a realisation may end."""

STATUS = {"ok": 0, "not_at_rest": 1, "diverged": 2, "left_grid": 3, "timeout": 4, "crashed": 5, "lost": 6, "refused": 7}
FAILED = frozenset({"diverged", "left_grid", "timeout", "crashed", "lost", "refused"})  # their quantities are NaN
STATUS_NAMES = {code: name for name, code in STATUS.items()}
FAILED_CODES = frozenset(STATUS[name] for name in FAILED)
BY_CHANCE = frozenset(STATUS[name] for name in ("timeout", "crashed", "lost"))  # may end otherwise the next time
