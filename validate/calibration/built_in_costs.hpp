#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// Unit costs without a calibration, and what sums over rays cost beside counting hits: unit costs are calibrated with rays of equal power,
/// whose hits are counted.
namespace detp::validate {

/// Unit costs of an engine, measured by `detp calibrate` on a cloud machine with AVX-512; the costs of threads are from its
/// two cores. Times on another machine may differ by a factor of two, which is two of CostTable::relative_errors, or by the ratio of the vector widths; calibrate that
/// machine.
[[nodiscard]] CostTable built_in_unit_costs(Engine engine = Engine::simd);

/// The costs if the rays' powers differ: the simd engine then adds powers for each hit, handles the three classes of a disc's
/// rays one by one, and keeps sums for each disc. In units of p, the time for placing a disc in a leaf: a visit of a disc
/// takes p longer, a hit 0.1 p, and placing a disc in a leaf 0.8 p.
///
/// Source     measured (one thread, AVX-512, p = 29 ns): brute force, sphere caches and cells with spheres 24 to 40 ns a visit;
///            box trees 24 ns for each disc
/// Accuracy   box trees on @interior, @cornell and @tree-coarse with d = 0.5 to 4 % and on uniform discs with 1000 rays: the
///            time of a search without sums plus this is 0.83 to 1.21 times that with sums
[[nodiscard]] CostTable costs_of_sums(CostTable costs);

/// What a search adds up.
struct SumsOfSearch {
  double rays = 0;
  double hits = 0;
  double discs = 0;
  double blocks = 1;      ///< of photons (sim::PhotonBlocks), whose sums are added up
  double bands = 1;       ///< of powers
  bool errors = false;    ///< standard errors
  bool numbered = false;  ///< rays have photon numbers
};

/// What standard errors and further bands add to the time of a search whose powers differ, in seconds. Scaled to the machine of the costs by its
/// time for a test of a ray against a disc.
///
/// Standard errors of one band: for each hit 0.9 ns if each ray is a photon of its own, and 9 ns if rays have photon numbers, because a disc's
/// hits are then brought into the order of the rays. Measured on box trees (one thread, AVX-512, 6.2·10⁶ hits of 50 000 discs: 76 ms without,
/// 82 and 133 ms with errors).
///
/// Each further band: for each ray its largest power is found, for each hit a power is added, for each disc and block of photons a sum, with
/// standard errors likewise squares. Fitted to four workloads on the faces of a cube (validate/tools/band_times.cpp; AMD EPYC, Zen 5, AVX-512);
/// the README of this folder has the errors.
[[nodiscard]] double sums_seconds(const SumsOfSearch& sums, const CostTable& costs);

}  // namespace detp::validate
