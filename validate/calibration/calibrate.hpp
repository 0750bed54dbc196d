#pragma once

#include <stop_token>
#include <vector>

#include "calibration.hpp"
#include "cost_fit.hpp"
#include "detp/sim/base/phase.hpp"

/// Measures the unit costs of this machine.
namespace detp::validate {

struct CalibrationOptions {
  double seconds = 8;  ///< no run starts after this time, but some small workloads are always measured
  int threads = 0;     ///< most threads of a run; 0: all cores; 1: costs of threads are not measured
  std::stop_token stop = {};
  sim::ReportPhase progress = {};
};

struct MeasuredCalibration : Calibration {
  /// of each technique and engine; none for those with too few runs and, of the plain engine, for those whose engines are the same, which
  /// have the built-in costs, and those of the simd engine
  std::vector<CostFit> fits = {};
  std::vector<ThreadFit> thread_fits = {};
  double threads_left_out_median_error = 0;  ///< of all runs on more threads, from their times on one; 0 without any
  std::size_t workloads = 0;                 ///< measured
  double seconds = 0;                        ///< that the calibration took
  bool stopped = false;  ///< a stop request came: the costs are fitted to the workloads measured until then
};

/// Times all exact techniques, with several parameters each, on samples in a cube and on its faces: 10² … 10⁵ discs and rays, from
/// few to very many hits; by both engines where they differ; box trees and brute force also with up to 10⁶ discs or rays. The samples are uniform, those of
/// every third workload in clusters. The discs of half the workloads are in order along a curve. The rays of half the
/// workloads are isotropic lines; those of the others are pieces of such lines, or of paths from sample to sample. Runs of
/// more than 0.012 s (0.2 s with so many discs or rays) are left out.
///
/// The first half of the time goes to making as many workloads as it suffices for, and timing their candidates once. Rounds over all
/// of them follow, so that seconds lie between two times of a candidate: a processor that is slow for a while is so for one of them. In a
/// round, a candidate is run twice in succession, the first time for the caches; the shortest time counts, of the wall clock or of the
/// processor: time that other programs took is no cost. Of all rounds, too; all costs are then multiplied by the
/// median over the candidates of their rounds' median over the shortest, at most 1.1. A candidate whose shortest times of two of three
/// rounds agree within 5 % is timed no more. On every second workload, each run of the simd engine whose work is divided alternates with runs on 2, 4, … threads, by the
/// wall clock; if these times never agree, they are left out.
///
/// Fits the unit costs of each technique and engine to its runs on one thread, in seconds (fit_costs); the usual costs are
/// the built-in ones. Fits the costs of threads to the runs on more threads. A technique with too few runs (10, or 5 on
/// more threads) keeps the built-in costs.
[[nodiscard]] MeasuredCalibration calibrate(const CalibrationOptions& options = {});

}  // namespace detp::validate
