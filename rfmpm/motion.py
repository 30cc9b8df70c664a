"""Motion of named points over time: displacement, velocity and acceleration."""

import numpy as np

from rfmpm.mpm.state import Points, Progress

INTERVAL = 0.02  # [s] of model time from one sample to the next, where the study does not say


class Motion:
    """Follows the material points that lie nearest to the named places at the start.

    The acceleration of a sample is the mean since the sample before, the difference of velocities over that time, so
    that it adds up to the velocity again; a point's acceleration within a step is noise of the grid.
    """

    def __init__(self, study, points: Points):
        places = np.array([(place.x_m, place.y_m) for place in study.history])
        position = np.column_stack(points.position)
        self.nearest = np.array([np.argmin(np.hypot(*(position - place).T)) for place in places])
        self.interval = study.output.history_interval_s or INTERVAL
        self.live, self.first = points, position[self.nearest]
        self.names = np.array([place.name for place in study.history])
        self.times, self.moved, self.speeds = [], [], []
        self.sample(0.0)

    def sample(self, time: float) -> None:
        """Note where the points are, at a model time [s]."""
        self.times.append(time)
        self.moved.append(np.column_stack([c[self.nearest] for c in self.live.position]) - self.first)
        self.speeds.append(np.column_stack([c[self.nearest] for c in self.live.velocity]))
        self.next_sample = time + self.interval

    def look(self, now: Progress, is_over: bool) -> None:
        """Add a sample if it is time, or the end."""
        if is_over or now.time >= self.next_sample:
            self.sample(now.time)

    def history(self) -> dict[str, np.ndarray]:
        """What has been seen, by the names of the table of variables.

        Returns:
            Names, shape (k,), initial positions, shape (k,), times, shape (m,), and motion, shape (m, k).
        """
        times, moved, velocity = np.array(self.times), np.array(self.moved), np.array(self.speeds)
        acceleration = np.zeros_like(velocity)
        acceleration[1:] = np.diff(velocity, axis=0) / np.diff(times)[:, None, None]
        motion = {"displacement": moved, "velocity": velocity, "acceleration": acceleration}
        history = {
            "history_point": self.names,
            "motion_time": times,
            "history_x": self.first[:, 0],
            "history_y": self.first[:, 1],
        }
        for name, values in motion.items():
            history |= {f"history_{name}_x": values[..., 0], f"history_{name}_y": values[..., 1]}
        return history
