#pragma once

#include "detp/model/vocabulary/vocabulary.hpp"

/// A few samples far from the others (Workload::central): the central samples and the far ones as workloads of their own.
///
/// A box tree puts far samples into nodes of their own, near its root. So its counts are about those of two trees: one
/// over the far samples, in which as many samples as a node has children stand for all central samples; and one over the
/// central samples, searched with the rays that cross the sphere around them.
///
/// Techniques whose cells divide the box of all samples evenly take the box of all. So does the sphere tree, whose nodes
/// of successive samples mix far samples with central ones on each level.
///
/// Source     our derivation.
/// Accuracy   5 samples of 10⁴ at up to 300 times the size of the others, lines: tests of boxes 10 %
///            (tests/validate/choice/outlier_counts.test.cpp). Lists and culls of the far samples are rough.
namespace detp::model {

/// The central samples and the rays that cross the sphere around them, at least one ray.
[[nodiscard]] Workload central_workload(const Workload& workload);

/// The far samples and `parts` that stand for the central samples, with all rays.
[[nodiscard]] Workload far_workload(const Workload& workload, double parts);

/// The counts of both workloads together, from those of each.
[[nodiscard]] Counts<double> with_far_samples(const Workload& workload, const Counts<double>& central,
                                              const Counts<double>& far);

}  // namespace detp::model
