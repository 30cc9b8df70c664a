"""CPU time of one realisation, and covariance error, of a method or of a peer."""

import time
import tracemalloc
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import nan

import numpy as np

from rfmpm.benchmark.fields import peers
from rfmpm.benchmark.fields.cases import Case
from rfmpm.random_fields.conditioning import condition, update
from rfmpm.random_fields.methods import METHODS, covariance_error

LAGS = 8  # per direction: quarters of theta up to two
BUDGET = 6.0  # CPU seconds for the repeats of one method or peer
LARGEST_PEER_COUNT = {"gstools": 20_000, "geone": 10_000_000, "gaussianfft": 10_000_000}  # above, a part is timed
SAMPLES, SAMPLED_VALUES = 400, 4_000_000  # realisations for a sampled error, as far as so many values reach


@dataclass(frozen=True)
class Measurement:
    """One method or peer in one case; times in CPU milliseconds, NaN where not measured."""

    case: str
    name: str
    preparing: float
    drawing: float  # one realisation, from xi to the field; a peer's includes its random numbers
    numbers: float  # random numbers of one realisation, by numpy
    error: float  # covariance, largest
    noise: float  # standard error of a sampled error; 0 for a deterministic one
    memory: float  # peak of one realisation, with its xi and field [MB]
    remark: str

    @property
    def total(self) -> float:
        """Random numbers and field [ms]."""
        return self.drawing + self.numbers


def measure(case: Case, quick: bool) -> Iterator[Measurement]:
    """Every method of the case, then every peer that is installed."""
    budget = 0.5 if quick else BUDGET
    for name, options in case.methods:
        yield _method(case, name, options, budget)
    if case.correlation == "markov_ellipsoidal":
        for name in peers.installed():
            peer = peers.PEERS[name]
            if not (peer.needs_lattice and case.is_scattered) and (peer.conditions or not case.data_count):
                yield _peer(case, name, peer.make, budget)


def _method(case: Case, name: str, options: dict, budget: float) -> Measurement:
    method, correlation = METHODS[name], case.kernel
    started = time.process_time()
    record = method.prepare(correlation, case.points, **options)
    conditioning = condition(correlation, case.points, case.data) if case.data_count else None
    preparing = time.process_time() - started
    generator, own = np.random.default_rng(0), method.n_variables(record)
    count = own + (conditioning.n_variables if conditioning else 0)

    def field(xi: np.ndarray) -> np.ndarray:
        z = method.transform(record, xi[:own])
        return update(conditioning, z, xi[own:]) if conditioning else z

    xi = generator.standard_normal(count)
    field(xi)  # compiles
    drawing = _least(lambda: field(xi), budget)
    numbers = _least(lambda: generator.standard_normal(count), budget / 4.0)
    tracemalloc.start()
    field(generator.standard_normal(count))
    memory = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    label = name + "".join(f", {key} = {value:.3g}" for key, value in options.items())
    error, remark = covariance_error(name, record), "deterministic error"
    if conditioning:
        remark += f"; of the conditional covariance {conditioning.covariance_error:.1e} more"
    return Measurement(case.name, label, 1e3 * preparing, drawing, numbers, error, 0.0, memory / 1e6, remark)


def _peer(case: Case, name: str, make: Callable[[Case], peers.Draw], budget: float) -> Measurement:
    part, remark = case, "sampled error"
    most = LARGEST_PEER_COUNT[name]
    count = case.columns * case.rows
    if count > most:
        share = most / count
        part = Case(case.name, case.correlation, case.columns, max(1, int(case.rows * share)), (), {})
        remark = f"time of {part.columns * part.rows:,} points, in proportion; sampled error of these"
    started = time.process_time()
    draw = make(part)
    draw(0)
    preparing = time.process_time() - started
    factor = count / (part.columns * part.rows)
    drawing = factor * _least(lambda: draw(1), budget)
    if case.data_count:
        return Measurement(case.name, name, 1e3 * preparing, drawing, 0.0, nan, 0.0, nan, "error not sampled")
    error, noise = _sampled_error(part, draw, budget)
    return Measurement(case.name, name, 1e3 * preparing, drawing, 0.0, error, noise, nan, remark)


def _least(run: Callable[[], object], budget: float) -> float:
    # Least CPU time of repeats within the budget [ms].
    best, spent, repeats = float("inf"), 0.0, 0
    while spent < budget and (repeats < 300 or spent < 0.1 * budget):
        started = time.process_time_ns()
        run()
        used = 1e-9 * (time.process_time_ns() - started)
        best, spent, repeats = min(best, used), spent + max(used, 1e-6), repeats + 1
    return 1e3 * best


def _sampled_error(case: Case, draw: peers.Draw, budget: float) -> tuple[float, float]:
    # Largest difference of the mean product at lags up to two theta along both axes, and the standard error there.
    pairs, asked = _pairs(case)
    sums, squares, count, started = np.zeros(len(pairs)), np.zeros(len(pairs)), 0, time.process_time()
    most = max(20, min(SAMPLES, SAMPLED_VALUES // len(case.points)))
    while count < most and (count < 3 or time.process_time() - started < budget):
        field = draw(100 + count)
        products = np.array([np.mean(field[first] * field[second]) for first, second in pairs])
        sums, squares, count = sums + products, squares + products**2, count + 1
    mean = sums / count
    noise = np.sqrt(np.maximum(squares / count - mean**2, 0.0) / (count - 1))
    worst = int(np.argmax(np.abs(mean - asked)))
    return float(abs(mean[worst] - asked[worst])), float(noise[worst])


def _pairs(case: Case) -> tuple[list[tuple[np.ndarray, np.ndarray]], np.ndarray]:
    # Point numbers of pairs at each lag, and the correlation asked there, the variance first.
    points, correlation = case.points, case.kernel
    if case.is_scattered:
        everything = np.arange(len(points))
        return [(everything, everything)], np.ones(1)
    node = np.arange(len(points)).reshape(case.rows, case.columns)
    pairs, asked = [(node.ravel(), node.ravel())], [1.0]
    for theta, along_x in ((case.theta_h, True), (case.theta_v, False)):
        for k in range(1, LAGS + 1):
            lag = max(1, round(0.25 * k * theta / case.spacing))
            if lag >= (case.columns if along_x else case.rows):
                continue
            first, second = (node[:, :-lag], node[:, lag:]) if along_x else (node[:-lag], node[lag:])
            pairs.append((first.ravel(), second.ravel()))
            distance = np.array([lag * case.spacing])
            asked.append(float(correlation.rho(distance * along_x, distance * (not along_x))[0]))
    return pairs, np.array(asked)
