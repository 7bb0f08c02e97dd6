"""How well a share is known from a number of trials."""

from dataclasses import dataclass

CONFIDENCE = 0.95


@dataclass(frozen=True, kw_only=True)
class Share:
    """A probability, estimated.

    Attributes:
        passed, flown: successes and trials.
        estimate: their ratio.
        low, high: ends of the exact interval at `CONFIDENCE`.
    """

    passed: int
    flown: int
    estimate: float
    low: float
    high: float

    @property
    def width(self) -> float:
        """Of the interval."""
        return self.high - self.low


def share(passed: int, flown: int, confidence: float = CONFIDENCE) -> Share:
    """The exact interval of Clopper and Pearson (Biometrika 26, 1934, 404-413).

    Args:
        passed: successes, of `flown` > 0 trials.
        confidence: that the interval holds the probability, at least.
    """
    # Importing SciPy's special functions takes a tenth of a second, its statistics a second more.
    from scipy.special import betaincinv  # noqa: PLC0415

    tail = 0.5 * (1.0 - confidence)
    low = float(betaincinv(passed, flown - passed + 1, tail)) if passed else 0.0
    high = 1.0
    if passed < flown:
        high = float(betaincinv(passed + 1, flown - passed, 1.0 - tail))
    return Share(passed=passed, flown=flown, estimate=passed / flown, low=low, high=high)
