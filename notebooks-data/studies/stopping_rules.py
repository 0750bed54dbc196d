#!/usr/bin/env python3
"""Rules that end the estimate of one mean when its relative error is small enough, on independent values: writes stopping_rules.csv.

    notebooks-data/studies/stopping_rules.py notebooks-data/stopping_rules.csv
    notebooks-data/studies/stopping_rules.py --quick

A row for each rule and distribution: 4000 runs, target 10 % with 95 %. All rules begin with 1/20 of the best fixed size, which knows the variance;
those that look at any time look 50 times in it. All runs of a rule are made at once. The rule `pairs of batches` is that of
validate/stopping/run_until.hpp, written here once more for one mean; the command is not called. Half a minute. Rows that the file has are kept,
and not made again; --quick prints a table of 200 runs. Needs numpy and scipy.

The random numbers are not those of the published file, so `inside` differs from it by chance: by some 14 of 4000 at 95 %. The published rows of
`pairs of batches` are of the rule as it was until 2026-11-29, when it could not end after a stage that was not planned to reach the target. Such a
rule takes 3 to 5 % fewer values.
"""
import math
import pathlib
import sys

import numpy
from scipy.special import fdtri, gammainc, ndtri, stdtrit

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from answers import Table

ERROR, CONFIDENCE = 0.1, 0.95
ALLOWED = 1 - CONFIDENCE
FIRST, LOOKS = 20, 50  # in the best fixed size
BATCHES = 32


class Distribution:
    """Values that a photon may bring to a disc, each with its probability; the first is 0."""

    def __init__(self, name, values, probabilities):
        self.name, self.values, self.probabilities = name, numpy.array(values), numpy.array(probabilities)
        self.mean = self.values @ self.probabilities
        relative_variance = self.values**2 @ self.probabilities / self.mean**2 - 1
        self.best = relative_variance * (ndtri(1 - ALLOWED / 2) / ERROR) ** 2  # the best fixed size
        self.first, self.look = self.best / FIRST, self.best / LOOKS

    def counts(self, random, sizes):
        """How often each value comes among so many."""
        return random.multinomial(sizes, self.probabilities).astype(float)

    def means(self, random, sizes):
        return self.counts(random, sizes) @ self.values / sizes


def hits(name, probability):
    """Hits of one power."""
    return Distribution(name, [0.0, 1.0], [1 - probability, probability])


def uneven_hits(name, probability, spread):
    """Hits whose power spreads over 12 values from 0 to 1 by a log-normal distribution, cut off at 0.1 %."""
    levels, reach = 12, 3.1  # standard deviations
    normal = reach * (2 * (numpy.arange(levels) + 0.5) / levels - 1)
    density = numpy.exp(-0.5 * normal**2)
    return Distribution(name, [0.0, *numpy.exp(spread * (normal - reach))], [1 - probability, *probability * density / density.sum()])


def whole(x):
    return max(1, math.ceil(x))


class Runs:
    """Sizes and estimates of runs that end one by one."""

    def __init__(self, count):
        self.left = numpy.arange(count)
        self.sizes, self.estimates = numpy.zeros(count), numpy.zeros(count)

    def end(self, ends, sizes, estimates):
        """Ends some of those that are left; which of these go on."""
        places = self.left[ends]
        self.sizes[places] = numpy.broadcast_to(sizes, len(ends))[ends]
        self.estimates[places] = estimates[ends]
        self.left = self.left[~ends]
        return ~ends

    def result(self):
        return self.sizes, self.estimates


def fixed(distribution, random, count):
    size = math.ceil(distribution.best)
    return numpy.full(count, size), distribution.means(random, numpy.full(count, size))


def naive(least):
    """Looks after each batch, from `least` batches on, at the standard error over the batches."""

    def rule(distribution, random, count):
        width, each = ndtri(1 - ALLOWED / 2), whole(distribution.look)
        runs, batches = Runs(count), 0
        mean, squares = numpy.zeros(count), numpy.zeros(count)
        while len(runs.left):
            found = distribution.means(random, numpy.full(len(runs.left), each))
            batches += 1
            change = found - mean
            mean = mean + change / batches
            squares = squares + change * (found - mean)
            if batches < least:
                continue
            standard_error = numpy.sqrt(squares / (batches - 1) / batches)
            on = runs.end(width * standard_error <= ERROR * mean, each * batches, mean)
            mean, squares = mean[on], squares[on]
        return runs.result()

    return rule


def gamma_bernoulli_hits():
    """Least number of hits k at which (k - 1)/G, G of a gamma distribution with shape k, is within 1 ± error with the confidence."""
    k = 2
    while gammainc(k, (k - 1) / (1 - ERROR)) - gammainc(k, (k - 1) / (1 + ERROR)) < CONFIDENCE:
        k += 1
    return k


def gamma_bernoulli(distribution, random, count):
    if len(distribution.values) != 2:
        return None
    k = gamma_bernoulli_hits()
    sizes = k + random.negative_binomial(k, distribution.probabilities[1], count)
    return sizes, (k - 1) / random.gamma(sizes)


class Sums:
    """All values so far of each run."""

    def __init__(self, distribution, counts):
        self.values, self.counts = distribution.values, counts

    def add(self, counts):
        self.counts = self.counts + counts

    def size(self):
        return self.counts.sum(axis=1)

    def mean(self):
        return self.counts @ self.values / self.size()

    def variance(self):
        return numpy.maximum(0, self.counts @ self.values**2 / self.size() - self.mean()**2)

    def keep(self, on):
        self.counts = self.counts[on]


def normal_mixture(distribution, random, count):
    tuned_for = 10 * distribution.first
    rho2 = (-2 * math.log(ALLOWED) + math.log(-2 * math.log(ALLOWED)) + 1) / tuned_for
    runs = Runs(count)
    sums = Sums(distribution, distribution.counts(random, numpy.full(count, whole(distribution.first))))
    while True:
        n, mean = sums.size(), sums.mean()
        radius = numpy.sqrt(sums.variance() * 2 * (n * rho2 + 1) / (n * n * rho2) * numpy.log(numpy.sqrt(n * rho2 + 1) / ALLOWED))
        sums.keep(runs.end((mean > 0) & (radius <= ERROR * mean), n, mean))
        if not len(runs.left):
            return runs.result()
        sums.add(distribution.counts(random, numpy.full(len(runs.left), whole(distribution.look))))


def betting(distribution, random, count):
    """Capital of bets against each mean of a grid around the true one; the grid is the only use of the truth. Few runs at once, for the memory."""
    parts = [betting_at_once(distribution, random, len(part)) for part in numpy.array_split(numpy.arange(count), max(1, count // 250))]
    return tuple(numpy.concatenate(column) for column in zip(*parts))


def betting_at_once(distribution, random, count):
    cells, reach, most = 250, 5, 0.5
    m = distribution.mean * (1 + ERROR * reach * (2 * numpy.arange(cells + 1) / cells - 1))
    limit = math.log(2 / ALLOWED)
    runs, size, sums = Runs(count), 0, None
    up, down, excluded = numpy.zeros((count, cells + 1)), numpy.zeros((count, cells + 1)), numpy.zeros((count, cells + 1), dtype=bool)
    variance = numpy.full(count, 0.25)
    while True:
        number = whole(distribution.look if size else distribution.first)
        size += number
        counts = distribution.counts(random, numpy.full(len(runs.left), number))
        bet = numpy.sqrt(2 * math.log(2 / ALLOWED) / (variance * size * math.log(1 + size)))[:, None]
        above, below = numpy.minimum(bet, most / m), numpy.minimum(bet, most / (1 - m))
        for value, times in zip(distribution.values, counts.T[:, :, None]):
            up += times * numpy.log1p(above * (value - m))
            down += times * numpy.log1p(-below * (value - m))
        excluded |= numpy.maximum(up, down) >= limit
        if sums is None:
            sums = Sums(distribution, counts)
        else:
            sums.add(counts)
        variance = (0.25 + size * sums.variance()) / (1 + size)
        found, estimates = estimates_of(m, excluded)
        on = runs.end(found, size, estimates)
        if not len(runs.left):
            return runs.result()
        up, down, excluded, variance = up[on], down[on], excluded[on], variance[on]
        sums.keep(on)


def estimates_of(m, excluded):
    """Whether the means that are left are near enough to each other, and the estimate with the least largest error over them."""
    last = len(m) - 1
    none_left = excluded.all(axis=1)
    below = numpy.maximum(numpy.argmin(excluded, axis=1) - 1, 0)
    above = numpy.minimum(last - numpy.argmin(excluded[:, ::-1], axis=1) + 1, last)
    low, high = m[below], m[above]
    found = excluded[:, 0] & excluded[:, -1] & (none_left | ((high - low) / (high + low) <= ERROR))
    return found, numpy.where(none_left, m[len(m) // 2], 2 * low * high / (low + high))


def half_width(means, alpha):
    """Of the interval by Student's t over the batches."""
    return stdtrit(BATCHES - 1, 1 - alpha / 2) * means.std(axis=1, ddof=1) / math.sqrt(BATCHES)


def doubled(distribution, random, count):
    each, look = math.ceil(distribution.first / BATCHES), 1
    runs = Runs(count)
    means = distribution.means(random, numpy.full((count, BATCHES), each))
    while True:
        mean = means.mean(axis=1)
        on = runs.end((mean > 0) & (half_width(means, ALLOWED / (look * (look + 1))) <= ERROR * mean), BATCHES * each, mean)
        if not len(runs.left):
            return runs.result()
        # Twice the values: old batches are joined by two, new ones follow.
        joined = means[on].reshape(-1, BATCHES // 2, 2).mean(axis=2)
        each, look = 2 * each, look + 1
        means = numpy.hstack([joined, distribution.means(random, numpy.full((len(joined), BATCHES // 2), each))])


def two_stages(distribution, random, count):
    pilot = BATCHES * math.ceil(distribution.first / BATCHES)
    means = distribution.means(random, numpy.full((count, BATCHES), pilot // BATCHES))
    mean = means.mean(axis=1)
    known = mean > 0
    sizes = numpy.full(count, pilot)
    sizes[known] = numpy.maximum(pilot, numpy.ceil(pilot * (half_width(means, ALLOWED)[known] / (ERROR * mean[known])) ** 2))
    more = sizes - pilot
    goes_on = more > 0
    estimates = mean.copy()
    second = distribution.means(random, more[goes_on])
    estimates[goes_on] = (pilot * mean[goes_on] + more[goes_on] * second) / sizes[goes_on]
    return sizes, estimates


def pairs_of_batches(distribution, random, count):
    """The rule of run_until. For one mean, the noise has Fisher's distribution F(1, m)."""
    share_of_tests, share_of_looks = 0.9, 0.05
    most_growth, least_growth, safety = 7, 0.1, 1.05
    runs = Runs(count)
    stage = numpy.full(count, float(max(whole(distribution.first), 2 * BATCHES)))
    planned = numpy.zeros(count, dtype=bool)
    tests, looks, size, total = numpy.zeros(count), numpy.zeros(count), numpy.zeros(count), numpy.zeros(count)
    pairs, sums, sums_of_squares = numpy.zeros(count), numpy.zeros(count), numpy.zeros(count)

    def error_of_test():
        return share_of_tests * ALLOWED * 2 * 3.0 ** -(tests + 1)

    def high(error):
        """The upper end of the noise."""
        mean = sums / pairs
        variance_of_mean = numpy.maximum(0, sums_of_squares / pairs - mean**2) / (pairs - 1)
        with numpy.errstate(divide="ignore", invalid="ignore"):
            freedom = numpy.where(variance_of_mean > 0, numpy.clip(2 * mean**2 / variance_of_mean, 0.1, pairs), pairs)
            square = numpy.maximum(0, (total / size) ** 2 - mean / size)
            found = numpy.sqrt(mean / size / square * fdtri(1, freedom, 1 - error))
        return numpy.where((mean > 0) & (square > 0), found, numpy.inf)

    while True:
        each = numpy.maximum(1, numpy.ceil(stage / BATCHES)).astype(int)
        means = distribution.means(random, numpy.broadcast_to(each[:, None], (len(each), BATCHES)))
        size, total = size + BATCHES * each, total + each * means.sum(axis=1)
        of_pairs = (means[:, ::2] - means[:, 1::2]) ** 2 * each[:, None] / 2
        pairs, sums, sums_of_squares = pairs + BATCHES // 2, sums + of_pairs.sum(axis=1), sums_of_squares + (of_pairs**2).sum(axis=1)
        error = numpy.where(planned, error_of_test(), share_of_looks * ALLOWED * 0.5 ** (looks + 1))
        tests, looks = tests + planned, looks + ~planned
        on = runs.end(high(error) <= ERROR, size, total / size)
        if not len(runs.left):
            return runs.result()
        tests, looks, size, total, pairs, sums, sums_of_squares = (one[on] for one in [tests, looks, size, total, pairs, sums, sums_of_squares])
        needed = size * (high(error_of_test()) / ERROR) ** 2
        more = numpy.maximum(safety * needed - size, least_growth * size)
        stage, planned = numpy.minimum(more, most_growth * size), more <= most_growth * size


RULES = [
    ("known variance", "a size fixed before", fixed),
    ("each batch, from 2", "naive", naive(2)),
    ("each batch, from 5", "naive", naive(5)),
    ("Gamma Bernoulli", "huber2017", gamma_bernoulli),
    ("normal mixture", "howard2021, waudbysmith2024: asymptotic", normal_mixture),
    ("betting", "waudbysmith2023: hedged capital", betting),
    ("two stages", "stein1945, Student's t of 32 batches", two_stages),
    ("doubled sizes", "error spent 1/(j(j + 1)), Student's t of 32 batches", doubled),
    ("pairs of batches", "run_until", pairs_of_batches),
]
DISTRIBUTIONS = [
    hits("hits 10 %", 0.1),
    hits("hits 1 %", 0.01),
    hits("hits 0.1 %", 0.001),
    uneven_hits("hits 10 %, uneven powers", 0.1, 0.7),
    uneven_hits("hits 1 %, uneven powers", 0.01, 1),
]


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    quick = "--quick" in sys.argv
    count = 200 if quick else 4000
    table = Table("distribution,rule,source,target,confidence,runs,inside,size_over_best,size_over_best_95", None if quick else sys.argv[1])
    kept = {(row["distribution"], row["rule"]) for row in table.kept}
    for number, distribution in enumerate(DISTRIBUTIONS):
        for place, (name, source, rule) in enumerate(RULES):
            if (distribution.name, name) in kept:
                continue
            found = rule(distribution, numpy.random.default_rng([number, place]), count)
            if found is None:
                continue
            sizes, estimates = found
            inside = int((abs(estimates / distribution.mean - 1) <= ERROR).sum())
            middle, high = (f"{one:.4g}" for one in numpy.quantile(sizes / distribution.best, [0.5, 0.95]))
            table.add(distribution.name, name, source, ERROR, CONFIDENCE, count, inside, middle, high)
    table.done()


main()
