#pragma once

#include "detp/model/vocabulary/prediction.hpp"
#include "detp/model/vocabulary/unit_costs.hpp"

/// Processes (ranks) that share a search.
namespace detp::model {

/// A search, as one process would do it. Seconds are those on the threads that each rank has.
struct SharedSearch {
  double rays = 0;
  double photons = 0;  ///< emitted; lines: as many as rays
  double discs = 0;
  double photons_in_block = 1 << 18;  ///< the smallest part of the rays that is shared
  bool photon_paths = false;          ///< they are made once to count them; those that are not kept are made again
  double kept_bytes = 0;              ///< of counted photon paths, that a rank keeps at most
  bool standard_errors = false;
  double make_seconds = 0;  ///< for making all rays once, and checking them
  double build_seconds = 0;
  double search_seconds = 0;
  double each_ray_seconds = 0;  ///< of these, for what each ray takes however few the discs are
  double scene_bytes = 0;       ///< of what every rank has besides discs: the mesh and its ray caster
};

/// Point to point, between rank 0 and another.
struct Network {
  double bytes_per_second = 1.25e9;  ///< 10 Gbit/s
  double latency = 50e-6;            ///< seconds for a message
};

/// What a rank needs; of the slowest.
struct SharedTime {
  double count = 0;  ///< seconds for counting photons
  double make = 0;   ///< for making its rays
  double build = 0;  ///< of an index
  double search = 0;
  double collect = 0;  ///< until rank 0 has what the others found
  double memory = 0;   ///< bytes of rank 0, which has the result
  double traffic = 0;  ///< bytes that rank 0 receives; each of the others sends its part of them

  [[nodiscard]] double total() const { return count + make + build + search + collect; }
};

/// Ranks share the rays: each has whole blocks of photons, and an index of all discs.
///
///     T = [T_m/P] + s ((1 - f) T_m + T_s) + T_b + (P - 1)(L + m/W)        s = ⌈B/P⌉/B
///     m = n_P (32 + 8 l)        l = 2 log₂(B/P), at least 1
///     f = K/(72 n_R/P), at most 1; for lines 0
///
///   where  T_m, T_b, T_s  seconds for making rays, for the index and for the search; [T_m/P] only of photon paths
///          f      share of its photon paths that a rank keeps from counting; K: bytes it may keep
///          B      number of blocks of photons
///          m      bytes that a rank sends: its sums under way, and those of the largest subtrees of its blocks; with standard errors
///                 56 + 8 l more for each disc
///          L, W   latency and bytes per second of the network
///
/// The search is taken to be proportional to the rays: that of ⌈B/P⌉ blocks costs s T_s. Throws std::invalid_argument unless P >= 1, and as
/// check(SharedSearch).
[[nodiscard]] SharedTime share_rays(const SharedSearch& search, double ranks, const Network& network = {});

/// Ranks share the discs: each makes all rays but those it keeps from counting, and has an index and sums of its own discs.
///
///     T = [T_m/P] + (1 - f/P) T_m + T_r + (T_b + T_s - T_r)/P + (P - 1)(L + n_P/P · 20/W)
///
/// T_r is the part of T_s that each ray takes however few the discs are, such as bringing it into the search. The bytes are the numbers of the
/// discs, their hits and irradiance; with standard errors 16 more. The rest of the search is taken to be shared evenly. That is too little for culls
/// some levels below the root of the index, which several ranks make for the same rays, and too much for visits of discs to blocks of rays, since a
/// rank's blocks follow its own discs. Throws as share_rays.
[[nodiscard]] SharedTime share_discs(const SharedSearch& search, double ranks, const Network& network = {});

/// The share of a predicted search that each ray takes however few the discs are: for bringing it into the search, and for
/// the tests of a box tree's nodes below the root; 0 to 1.
[[nodiscard]] double share_of_each_ray(const Prediction& prediction, const UnitCosts& costs, double discs);

/// Throws std::invalid_argument unless counts are >= 1 and seconds, bytes >= 0, all finite, and unless the search takes at least each_ray_seconds.
void check(const SharedSearch& search);

}  // namespace detp::model
