#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/model/vocabulary.hpp"
#include "detp/sim/geometry.hpp"

/// One question, many techniques: which rays cross which discs? All answers but the published walk's are the same.
namespace detp::sim {

/// The rays and the discs. Borrowed: both must outlive every call that takes the problem.
struct Problem {
  std::span<const Ray> rays;
  std::span<const Disc> discs;
  Sphere enclosing;           ///< S₀: holds every disc whole; rays may start or pass outside it
  bool front_facing = false;  ///< count only rays that arrive at a disc's front
};

/// The smallest sphere around the box of the discs' centres, plus the largest radius.
[[nodiscard]] Sphere enclosing_sphere(std::span<const Disc> discs);

/// A problem with its S₀. Throws std::invalid_argument where there is no ray or no disc, or one is malformed: a number
/// that is not finite, a direction or normal that is not unit (to 1e-6), a radius or length <= 0, a negative power.
[[nodiscard]] Problem make_problem(std::span<const Ray> rays, std::span<const Disc> discs, bool front_facing = false);

struct Pair {
  std::uint32_t ray;
  std::uint32_t disc;
  auto operator<=>(const Pair&) const = default;
};

/// Where the time went, in seconds.
struct Phases {
  double order = 0;   ///< sorting the samples
  double build = 0;   ///< building an index
  double search = 0;  ///< all the rest: rebuilding spheres, traversing, testing discs
  [[nodiscard]] double total() const { return order + build + search; }
};

struct RunOptions {
  bool count = true;          ///< fill in Outcome::counts; a timing run turns it off and pays nothing for it
  bool pairs = false;         ///< fill in Outcome::pairs
  std::stop_token stop = {};  ///< asked between discs or blocks of rays
};

/// What a technique found, per disc in the order of the problem's discs.
struct Outcome {
  std::vector<std::uint64_t> hits;  ///< rays that cross the disc
  std::vector<double> irradiance;   ///< their power over π d², powers summed in the rays' order
  std::uint64_t total_hits = 0;
  Counts<std::uint64_t> counts;  ///< all zero unless asked for (`hits` always holds total_hits)
  std::vector<Pair> pairs;       ///< sorted by ray, then disc; empty unless asked for
  Phases seconds;
  bool stopped = false;  ///< the stop was asked for: what is here is partial
};

/// Runs one technique. Throws std::invalid_argument for parameters out of range or not the technique's, and
/// std::length_error, naming the bytes, where an index would not fit the memory.
[[nodiscard]] Outcome run(const Problem& problem, const Candidate& candidate, const RunOptions& options = {});

}  // namespace detp::sim
