"""The random numbers of sim/geometry/random.hpp, so that scripts make the scenes that programs made (Philox4x64-10 of Random123)."""

MASK = 2**64 - 1
SCENE = 5  # streams, sim::Stream
TESTS = 6


def uniform4(seed, stream, index, sub_index=0):
    """Four independent uniform numbers in [0, 1) with 53 bits."""
    words = [index, sub_index, 0, 0]
    for i in range(10):
        first = 0xD2E7470EE14C6C93 * words[0]
        second = 0xCA5A826395121157 * words[2]
        keys = (seed + i * 0x9E3779B97F4A7C15) & MASK, (stream + i * 0xBB67AE8584CAA73B) & MASK
        words = [(second >> 64) ^ words[1] ^ keys[0], second & MASK, (first >> 64) ^ words[3] ^ keys[1], first & MASK]
    return [(word >> 11) * 2.0**-53 for word in words]
