#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

#include "detp/sim/geometry/geometry.hpp"
#include "embree_mode.hpp"

/// What a user would do instead: all hits by Embree, in its single precision.
///
/// No other peer is measured. nanoflann finds points near points: lines would have to be cut into balls, and discs
/// found twice told apart. CGAL's tree of boxes, which could hold discs in double precision, brings GMP and MPFR with
/// it and has neither packets nor SIMD: it would not be the fastest thing at hand on any workload.
namespace detp::validate {

/// What a peer found, per disc.
struct PeerOutcome {
  std::vector<std::uint64_t> hits;
  std::vector<double> irradiance;  ///< power over π d²
  bool stopped = false;            ///< the stop was asked for: what is here is partial
};

/// Embree 3 as its documentation advises: RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT, hits collected by the context's
/// filter, denormals flushed, aligned rays in single stores, coherent streams of 64. Its decisions are its own: a hit
/// near a disc's rim may be wrong by single precision's rounding.
///
/// The device is made once and its threads started before any timing.
class EmbreePeer {
 public:
  explicit EmbreePeer(int threads);
  ~EmbreePeer();
  EmbreePeer(const EmbreePeer&) = delete;
  EmbreePeer& operator=(const EmbreePeer&) = delete;

  /// From discs and rays in memory to irradiance in memory: conversion to single precision, build and trace. Rays are
  /// split over the threads, each with sums of its own. Throws std::runtime_error if Embree fails.
  [[nodiscard]] PeerOutcome run(std::span<const sim::Ray> rays, std::span<const sim::Disc> discs,
                                const EmbreeMode& mode, const std::stop_token& stop = {}) const;

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
};

}  // namespace detp::validate
