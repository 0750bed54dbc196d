"""The seconds of counts at unit costs, as model/vocabulary/unit_costs.hpp has them; one thread, simd engine."""
import math

NEAR_BYTES = 1.25e6


def doublings(counts):
    """From NEAR_BYTES to the bytes of the discs that are searched; 0 if they stay near."""
    discs = max(counts["placements"], counts["sorted"], counts["references"])
    if discs == 0:  # brute force
        discs = counts["disc_tests"] / counts["loaded"] if counts["loaded"] > 0 else counts["visits"]
    return math.log2(max(1, discs * 125 / NEAR_BYTES))


def long_tests(counts):
    """Tests of rays in lists of more than NEAR_BYTES."""
    discs = min(max(counts["placements"], counts["sorted"], counts["references"]), 1e9)
    most = min(max(2 ** math.ceil(math.log2(max(1, min(4 * int(discs), 2**24)))), 2**15), 2**24)
    block, near = min(counts["loaded"], most), NEAR_BYTES / 20
    if block <= near or counts["culls"] == 0:
        return 0
    mean = min(max(counts["cull_tests"] / counts["culls"], 1), near)
    return counts["cull_tests"] * math.log(block / near) / math.log(block / mean)


def seconds(counts, costs):
    """`counts` and `costs` (of one technique, by symbol) as in the JSON of the command."""
    far = doublings(counts)
    tests = counts["cull_tests"] + counts["disc_tests"]
    names = {"t": "cull_tests", "u": "disc_tests", "w": "disc_tests", "v": "steps", "n": "nodes", "c": "listed", "b": "placements", "g": "made",
             "s": "sorted", "l": "visits", "h": "hits", "i": "loaded", "z": "bytes_touched"}
    quantities = {symbol: counts[name] for symbol, name in names.items()} | {
        "r": counts["culls"] * (1 + 2 * far),
        "e": counts["segments"] / counts["loaded"] * tests if counts["loaded"] > 0 else 0,
        "m": max(counts["placements"], counts["sorted"], counts["visits"]) * far**2,
        "y": 20 * long_tests(counts) + 128 * max(0, counts["loaded"] - 2**17),
        "a": 1}
    return sum(cost * quantities[symbol] for symbol, cost in costs.items())
