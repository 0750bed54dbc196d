#include "index_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detp/model/lines/line_measure.hpp"
#include "detp/model/vocabulary/checks.hpp"

namespace detp::model {
namespace {

/// The three axes. Along the first the centres may have a fixed coordinate.
using Axes = std::array<PlaneCrossings, 3>;

double planes_across(const Axes& n) { return n[0].planes + n[1].planes + n[2].planes; }

double lines_through(const Axes& n, Insertion insertion) {
  return n[0].line_weight * (n[1].planes + n[2].planes) +
         uniform_crossings(1, insertion).line_weight * n[1].planes * n[2].planes;
}

double corners_in(const Axes& n) { return n[0].corner_weight * n[1].planes * n[2].planes; }

IndexAxis axis_of(const Valid<Workload>& workload, const Cells& cells, std::size_t axis) {
  return {cells.along[axis], cells.side, workload.box[axis], workload.disc_radius};
}

/// Share of the samples on the two faces across each axis, by area.
std::array<double, 3> face_shares(const Valid<Workload>& workload) {
  const auto& box = workload.box;
  std::array<double, 3> areas{box[1] * box[2], box[2] * box[0], box[0] * box[1]};
  const double all = areas[0] + areas[1] + areas[2];
  for (double& area : areas) area = all > 0 ? area / all : 1.0 / 3;
  return areas;
}

/// Weight 0 … 1 of samples on the faces of their box, estimated from the dimension.
double on_faces(const Valid<Workload>& workload) {
  return workload.sample_extent == 0 ? 1 - std::clamp(workload.dimension - 2, 0.0, 1.0) : 0;
}

/// Computes E and S, means over the places of the samples.
void set_overlapped(Cells& cells, const Valid<Workload>& workload) {
  const double x = workload.disc_radius / cells.side;
  const auto crossings_of = [&](std::size_t axis, Centres centres) {
    return crossings(axis_of(workload, cells, axis), centres, cells.insertion);
  };
  const Axes uniform{crossings_of(0, Centres::uniform), crossings_of(1, Centres::uniform),
                     crossings_of(2, Centres::uniform)};
  cells.overlapped = cells.seen = 0;
  const auto add = [&](const Axes& n, double weight) {
    const double planes = planes_across(n);
    const double lines = lines_through(n, cells.insertion);
    cells.overlapped += weight * (1 + planes + lines + corners_in(n));
    cells.seen += weight * faces_seen(x, planes, lines, cells.insertion);
  };
  const double faces = on_faces(workload);
  if (faces < 1) add(uniform, 1 - faces);
  if (faces == 0) return;
  const std::array<double, 3> shares = face_shares(workload);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Centres centres : {Centres::low_face, Centres::high_face})
      add({crossings_of(axis, centres), uniform[(axis + 1) % 3], uniform[(axis + 2) % 3]}, faces * shares[axis] / 2);
}

/// The probability that a disc overlaps a cell, from the terms of E: along each axis the centre lies in the cell's
/// slab, or the disc reaches into it.
double overlap_probability(const std::array<const Slabs*, 3>& slabs, std::size_t fixed, Centres centres,
                           double line_weight) {
  const auto at = static_cast<std::size_t>(centres);
  const Slabs& j = *slabs[(fixed + 1) % 3];
  const Slabs& k = *slabs[(fixed + 2) % 3];
  const double in_both = j.centred[0] * k.centred[0];
  const double in_one = j.reached[0].planes * k.centred[0] + j.centred[0] * k.reached[0].planes;
  const double in_none = j.reached[0].planes * k.reached[0].planes;
  const double in = slabs[fixed]->centred[at];
  const PlaneCrossings& reached = slabs[fixed]->reached[at];
  return in * (in_both + in_one) + slabs[fixed]->pierced[at] * line_weight * in_none + reached.planes * in_both +
         reached.line_weight * in_one + reached.corner_weight * in_none;
}

/// The probability that a disc overlaps a cell, averaged over the places of the samples.
class OverlapProbability {
 public:
  OverlapProbability(const Valid<Workload>& workload, Insertion insertion)
      : faces_(on_faces(workload)),
        shares_(face_shares(workload)),
        line_weight_(uniform_crossings(1, insertion).line_weight) {}

  [[nodiscard]] double operator()(const std::array<const Slabs*, 3>& slabs) const {
    double all = faces_ < 1 ? (1 - faces_) * overlap_probability(slabs, 0, Centres::uniform, line_weight_) : 0;
    for (std::size_t axis = 0; axis < 3 && faces_ > 0; ++axis)
      for (const Centres centres : {Centres::low_face, Centres::high_face})
        all += faces_ * shares_[axis] / 2 * overlap_probability(slabs, axis, centres, line_weight_);
    return std::min(all, 1.0);
  }

 private:
  double faces_;
  std::array<double, 3> shares_;
  double line_weight_;
};

}  // namespace

Cells index_cells(const Valid<Workload>& workload, double parts, Insertion insertion) {
  require_positive("cells along the longest side", parts);
  const double d = std::min(largest_radius(workload), 1e99);  // larger than all cells, but its volume does not overflow
  Cells cells{.side = (scene_side(workload) + 2 * d) / parts, .insertion = insertion};
  for (std::size_t axis = 0; axis < 3; ++axis)
    cells.along[axis] = std::max(1.0, std::ceil((workload.box[axis] + 2 * d) / cells.side * (1 - 1e-12)));
  set_overlapped(cells, workload);
  cells.overlapped = std::min(cells.overlapped, cells.count());
  const double face = cells.side * cells.side;
  cells.crossing = crossing_probability(workload, face * cells.side, 6 * face);
  cells.meeting = crossing_probability(workload, cells.overlapped * face * cells.side, cells.seen * face);
  return cells;
}

double occupied_cells(const Valid<Workload>& workload, const Cells& cells) {
  require_positive("cell side", cells.side);
  if (workload.dimension < 3 && workload.sample_extent > 0) {
    const double on_surface =
        std::min(cells.count(), std::max(1.0, 1.5 * sample_extent(workload) / (cells.side * cells.side)));
    const double weight = std::clamp(workload.dimension - 2, 0.0, 1.0);
    const double reach = std::pow(cells.count(), weight) * std::pow(on_surface, 1 - weight);
    return -reach * std::expm1(-workload.samples * cells.overlapped / reach);
  }
  std::array<SlabRuns, 3> axes;
  for (std::size_t axis = 0; axis < 3; ++axis)
    axes[axis] = axis > 0 && workload.box[axis] == workload.box[axis - 1]
                     ? axes[axis - 1]
                     : slab_runs(axis_of(workload, cells, axis), cells.insertion);
  const OverlapProbability overlap_of(workload, cells.insertion);
  double occupied = 0;
  for (std::size_t i = 0; i < axes[0].size; ++i)
    for (std::size_t j = 0; j < axes[1].size; ++j)
      for (std::size_t k = 0; k < axes[2].size; ++k) {
        const std::array<const Slabs*, 3> slabs{&axes[0].runs[i], &axes[1].runs[j], &axes[2].runs[k]};
        const double q = overlap_of(slabs);
        // With more than 40 expected discs in a cell, the share of empty cells is below 1e-17.
        const double held = workload.samples * q < 40 ? -std::expm1(workload.samples * std::log1p(-q)) : 1;
        occupied += slabs[0]->count * slabs[1]->count * slabs[2]->count * held;
      }
  return occupied;
}

namespace {

using std::numbers::pi;

constexpr std::array table{
#include "index_mailbox_table.inc"
};
constexpr double first = 1.0 / 16;  ///< x of the first entry; x grows by a factor of √2 from entry to entry

/// R(x), linear in log x; below the table linear in x.
double beyond_one_cell(double x) {
  if (x <= first) return 6 * pi + (table.front() - 6 * pi) * x / first;
  const double place = std::min(2 * std::log2(x / first), static_cast<double>(table.size() - 1));
  const auto entry = std::min(static_cast<std::size_t>(place), table.size() - 2);
  const double share = place - static_cast<double>(entry);
  return (1 - share) * table[entry] + share * table[entry + 1];
}

}  // namespace

double faces_seen(double x, double planes, double lines, Insertion insertion) {
  require_non_negative("disc radius over cell side", x);
  require_non_negative("planes that cross a disc", planes);
  require_non_negative("lines that pierce a disc", lines);
  if (insertion == Insertion::bounding_box) return 6 + 4 * planes + 2 * lines;
  return 6 + beyond_one_cell(x) / (1.5 * pi) * planes + 4.0 / 3 * lines;
}

}  // namespace detp::model
