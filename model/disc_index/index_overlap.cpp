#include "index_overlap.hpp"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <numbers>

namespace detp::model {
namespace {

using std::numbers::pi;

constexpr double most_planes = 64;   // across a radius; with more, treated as endless cells
constexpr double most_cells = 1e15;  // along an axis; larger numbers are not distinguished
constexpr double two_pi_squared = 8 / (pi * pi);

/// ∫ √(1 - u²) du from u = 0; the integrand is 0 beyond ±1.
double half_chords(double u) {
  const double v = std::clamp(u, -1.0, 1.0);
  return 0.5 * (v * std::sqrt((1 - v) * (1 + v)) + std::asin(v));
}

/// Mean of √((1 - n₂²)(1 - n₃²)) over the unit vectors with n₁ = z: √(z² + s⁴ sin²(2φ)/4), s² = 1 - z², over φ.
double mean_reach_around(double z) {
  const double s2 = (1 - z) * (1 + z);
  const double most = z * z + s2 * s2 / 4;
  return 2 / pi * std::sqrt(most) * boost::math::ellint_2(s2 / 2 / std::sqrt(most));
}

/// Crossings of a plane at that distance from the centre, in disc radii.
PlaneCrossings crossings_at(double distance, Insertion insertion) {
  const double u = std::abs(distance);
  if (u >= 1) return {};
  const double k = std::sqrt((1 - u) * (1 + u));
  if (insertion == Insertion::exact) {
    const double lines = k < 1 ? boost::math::ellint_2(k) - u * u * boost::math::ellint_1(k) : 1;
    return {k, two_pi_squared * lines, 0};
  }
  using Rule = boost::math::quadrature::gauss<double, 10>;
  const auto around = [](double z) { return boost::math::ellint_2(std::sqrt((1 - z) * (1 + z))); };
  return {k, two_pi_squared * Rule::integrate(around, 0, k),
          2 * two_pi_squared * Rule::integrate(mean_reach_around, 0, k)};
}

/// Share of the lines along an axis that pierce the disc at most `distance` disc radii beyond its centre, minus ½.
double pierced_up_to(double distance) {
  const double u = std::min(1.0, std::abs(distance));
  const double share =
      4 / pi * (0.75 * u * std::sqrt((1 - u) * (1 + u)) + 0.25 * std::asin(u) - 0.5 * u * u * std::acos(u));
  return distance < 0 ? -share : share;
}

bool is_spread(const IndexAxis& axis, Centres centres) {
  return centres == Centres::uniform && axis.room > 1e-6 * axis.disc;
}

/// The common coordinate of the centres, if they are not spread.
double centre_of(const IndexAxis& axis, Centres centres) {
  return centres == Centres::high_face ? axis.disc + axis.room : axis.disc;
}

/// Crossings of a plane that cuts the disc, for centres below the plane.
PlaneCrossings crossings_from_below(const IndexAxis& axis, double plane, Centres centres, Insertion insertion) {
  if (!is_spread(axis, centres)) {
    const double at = centre_of(axis, centres);
    return at < plane ? crossings_at((plane - at) / axis.disc, insertion) : PlaneCrossings{};
  }
  const double last = std::min(plane, axis.disc + axis.room);
  if (last <= axis.disc) return {};
  const double chords = half_chords(plane / axis.disc - 1) - half_chords((plane - last) / axis.disc);
  return uniform_crossings(chords * axis.disc / axis.room, insertion);
}

PlaneCrossings crossings_from_above(const IndexAxis& axis, double plane, Centres centres, Insertion insertion) {
  if (!is_spread(axis, centres)) {
    const double at = centre_of(axis, centres);
    return at >= plane ? crossings_at((plane - at) / axis.disc, insertion) : PlaneCrossings{};
  }
  const double first = std::max(plane, axis.disc);
  if (first >= axis.disc + axis.room) return {};
  const double chords =
      half_chords((axis.disc + axis.room - plane) / axis.disc) - half_chords((first - plane) / axis.disc);
  return uniform_crossings(chords * axis.disc / axis.room, insertion);
}

/// The probability that the centre lies between two planes.
double centred_between(const IndexAxis& axis, double low, double high, Centres centres) {
  if (!is_spread(axis, centres)) {
    const double at = centre_of(axis, centres);
    return low <= at && at < high ? 1 : 0;
  }
  return std::max(0.0, std::min(high, axis.disc + axis.room) - std::max(low, axis.disc)) / axis.room;
}

double pierced_between(const IndexAxis& axis, double low, double high, Centres centres, Insertion insertion) {
  if (is_spread(axis, centres) || insertion == Insertion::bounding_box)
    return centred_between(axis, low, high, centres);
  const double at = centre_of(axis, centres);
  return pierced_up_to((high - at) / axis.disc) - pierced_up_to((low - at) / axis.disc);
}

/// First and last plane that is crossed as in endless cells: at least 2d from both ends of the room grown by d.
std::array<double, 2> inner_planes(const IndexAxis& axis) {
  return {std::ceil(2 * axis.disc / axis.side), std::min(axis.cells - 1, std::floor(axis.room / axis.side))};
}

void add_slab(Slabs& run, const IndexAxis& axis, double j, Insertion insertion) {
  const double low = j * axis.side;
  const bool ends = j + 1 >= axis.cells;
  const double high = ends ? 2 * axis.disc + axis.room + low : low + axis.side;
  for (const Centres centres : {Centres::uniform, Centres::low_face, Centres::high_face}) {
    const auto place = static_cast<std::size_t>(centres);
    run.centred[place] += centred_between(axis, low, high, centres) / run.count;
    run.pierced[place] += pierced_between(axis, low, high, centres, insertion) / run.count;
    if (j > 0) run.reached[place] += 1 / run.count * crossings_from_below(axis, low, centres, insertion);
    if (!ends) run.reached[place] += 1 / run.count * crossings_from_above(axis, high, centres, insertion);
  }
}

/// Collects the slabs of an axis.
class SlabCollector {
 public:
  SlabCollector(const IndexAxis& axis, Insertion insertion) : axis_(axis), insertion_(insertion) {}

  /// Adds the slabs from `first` up to `last` in at most 5 runs; the runs towards the axis's end are shorter.
  void add_end(double first, double last, bool low_end) {
    const double count = last - first;
    const double runs = std::min(count, 5.0);
    for (double run = 0; run < runs; ++run) {
      const auto border = [&](double number) {
        const double place = number / runs * count;
        return first + (low_end ? std::floor(place) : std::ceil(place));
      };
      Slabs& slabs = slabs_.runs[slabs_.size++];
      slabs.count = border(run + 1) - border(run);
      for (double j = border(run); j < border(run + 1); ++j) add_slab(slabs, axis_, j, insertion_);
    }
  }

  /// Adds `count` slabs that are all equal to the one at `first`.
  void add_like(double first, double count) {
    Slabs& slabs = slabs_.runs[slabs_.size++];
    slabs.count = 1;
    add_slab(slabs, axis_, first, insertion_);
    slabs.count = count;
  }

  /// Adds all slabs as equal ones, with mean values.
  void add_mean() {
    Slabs& slabs = slabs_.runs[slabs_.size++];
    slabs.count = axis_.cells;
    for (const Centres centres : {Centres::uniform, Centres::low_face, Centres::high_face}) {
      const auto place = static_cast<std::size_t>(centres);
      slabs.centred[place] = slabs.pierced[place] = 1 / axis_.cells;
      slabs.reached[place] = 1 / axis_.cells * crossings(axis_, centres, insertion_);
    }
  }

  [[nodiscard]] const SlabRuns& slabs() const { return slabs_; }

 private:
  const IndexAxis& axis_;
  Insertion insertion_;
  SlabRuns slabs_;
};

}  // namespace

PlaneCrossings& PlaneCrossings::operator+=(const PlaneCrossings& other) {
  planes += other.planes;
  line_weight += other.line_weight;
  corner_weight += other.corner_weight;
  return *this;
}

PlaneCrossings uniform_crossings(double planes, Insertion insertion) {
  if (insertion == Insertion::exact) return {planes, 2 / pi * planes, 0};
  return {planes, 2 * two_pi_squared * mean_reach_product_2 * planes,
          8 * two_pi_squared / pi * mean_reach_product_3 * planes};
}

PlaneCrossings crossings(const IndexAxis& axis, Centres centres, Insertion insertion) {
  const double x = axis.disc / axis.side;
  if (x > most_planes || axis.cells > most_cells)
    return uniform_crossings(std::min(0.5 * pi * x, axis.cells - 1), insertion);
  PlaneCrossings all;
  const auto add = [&](double plane) {
    all += crossings_from_below(axis, plane * axis.side, centres, insertion);
    all += crossings_from_above(axis, plane * axis.side, centres, insertion);
  };
  const auto [first, last] = inner_planes(axis);
  double plane = 1;
  for (; plane < std::min(first, axis.cells); ++plane) add(plane);
  if (last >= plane) {  // if the centres are on a face, these cross nothing
    if (centres == Centres::uniform)
      all += uniform_crossings((last - plane + 1) * 0.5 * pi * axis.disc / axis.room, insertion);
    plane = last + 1;
  }
  for (; plane < axis.cells; ++plane) add(plane);
  return all;
}

SlabRuns slab_runs(const IndexAxis& axis, Insertion insertion) {
  SlabCollector collector(axis, insertion);
  const auto [first, last] = inner_planes(axis);
  if (axis.disc > most_planes * axis.side || axis.cells > most_cells) {
    collector.add_mean();
  } else if (last > first) {
    collector.add_end(0, first, true);
    collector.add_like(first, last - first);
    collector.add_end(last, axis.cells, false);
  } else {
    const double middle = std::ceil(axis.cells / 2);
    collector.add_end(0, middle, true);
    collector.add_end(middle, axis.cells, false);
  }
  return collector.slabs();
}

}  // namespace detp::model
