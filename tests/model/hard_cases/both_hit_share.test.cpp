#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <vector>

#include "detp/model/lines/line_measure.hpp"
#include "run.hpp"

using namespace detp;
using namespace detp::hard_cases;

namespace {

using Quad =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<34, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

/// ∫ f(s, s - p, q - s) ds from p to q by the trapezoidal rule over ln((s - p)/(q - s)). f·(q - s)^{1/2} and f/(s - p)
/// must stay finite. Accuracy 1e-18.
template <class Real, class Function>
Real integral(const Real& p, const Real& width, const Function& f) {
  const Real step = Real{3} / 8;
  static const std::vector<Real> powers = [&] {
    std::vector<Real> all;
    for (int i = -115; i <= 230; ++i) all.push_back(exp(step * i));
    return all;
  }();
  Real sum = 0;
  for (const Real& w : powers) {
    const Real rest = 1 / (1 + w);
    const Real from_p = width * w * rest;
    sum += f(Real{p + from_p}, from_p, Real{width * rest}) * w * rest * rest;
  }
  return sum * step * width;
}

/// Area common to two circles of radii a and b with distance c between centres; |a - b| < c < a + b.
Exact lens_area(const Exact& a, const Exact& b, const Exact& c) {
  const auto segment = [](const Exact& r, const Exact& from_centre) {
    const Exact cosine = std::clamp<Exact>(from_centre / r, -1, 1);
    return Exact{r * r * (acos(cosine) - cosine * sqrt(1 - cosine * cosine))};
  };
  const Exact from_a = (c * c + a * a - b * b) / (2 * c);
  return segment(a, from_a) + segment(b, c - from_a);
}

/// The documented integral of the lens area over all directions. Substitutes s = c sin θ, the distance of the projected
/// centres.
Exact share_by_lenses(const Exact& a, const Exact& b, const Exact& c) {
  const Exact small = std::min(a, b);
  const Exact p = abs(a - b);
  const Exact covered = support::pi() * small * small;
  const Exact area = support::pi() * b * b;
  if (c <= p) return covered / area;
  const Exact q = std::min<Exact>(c, a + b);
  const Exact lenses = integral<Exact>(p, q - p, [&](const Exact& s, const Exact&, const Exact& short_of_q) {
    return Exact{lens_area(a, b, s) * s / (c * sqrt((c - q + short_of_q) * (c + s)))};
  });
  return (covered * (1 - sqrt(1 - p * p / (c * c))) + lenses) / area;
}

/// The share of both spheres, integrated by parts. If the spheres overlap, the integral is subtracted from the share of
/// nested spheres; otherwise the integral is the share.
Quad share_by_chords(const Quad& a, const Quad& b, const Quad& c) {
  const Quad small = std::min(a, b);
  const Quad p = abs(a - b);
  const Quad nested = small / b * (small / b);
  // 113 bits hold the difference of two doubles of similar size exactly. Otherwise only the sum is rounded.
  const Quad c_less_p = small > std::max(a, b) / 2 ? Quad{c - p} : Quad{(c - std::max(a, b)) + small};
  if (c_less_p <= 0) return nested;
  const Quad c_less_sum = (c - std::max(a, b)) - small;
  const Quad pi = boost::math::constants::pi<Quad>();
  if (c_less_sum < 0) {
    const Quad loss = integral<Quad>(p, c_less_p, [&](const Quad& s, const Quad& from_p, const Quad& short_of_q) {
      return Quad{sqrt(short_of_q * (c + s) * from_p * (s + p) * (short_of_q - c_less_sum) * (a + b + s)) / s};
    });
    return nested - loss / (pi * c * b * b);
  }
  const Quad both = integral<Quad>(p, 2 * small, [&](const Quad& s, const Quad& from_p, const Quad& short_of_q) {
    const Quad cosine = sqrt((c_less_sum + short_of_q) * (c + s)) / c;
    return Quad{sqrt(short_of_q * (a + b + s) * from_p * (s + p)) * s / (1 + cosine)};
  });
  return both / (pi * c * c * b * b);
}

struct TwoSpheres {
  double a;
  double b;
  double c;
};

template <class Reference>
void compare(const char* formula, const TwoSpheres& it, const Reference& reference, Ledger& ledger) {
  ledger.compare(formula, model::both_hit_share(it.a, it.b, it.c), reference(it.a, it.b, it.c),
                 [&] { return fmt::format("a {:a}, b {:a}, c {:a}", it.a, it.b, it.c); });
}

void compare_by_lenses(const TwoSpheres& it, Ledger& ledger) {
  compare("share of both, by lenses", it, share_by_lenses, ledger);
}

void compare_by_chords(const TwoSpheres& it, Ledger& ledger) {
  compare(
      "share of both, by chords (113 bits)", it,
      [](double a, double b, double c) { return Exact{share_by_chords(a, b, c)}; }, ledger);
}

/// Spheres of radii a and b, with a ratio of at most `most_ratio` or 2. The distance c of their centres is arbitrary,
/// or close to |a - b|, where one sphere starts to leave the other, or close to a + b, where they separate.
TwoSpheres random_case(Draw& draw, double most_ratio) {
  const double b = draw.log_uniform(1e-100, 1e100);
  const double a =
      draw.whole(0, 3) == 0 ? b * (1 + draw.log_uniform(1e-16, 1)) : b * draw.log_uniform(1 / most_ratio, most_ratio);
  const double off = (draw.whole(0, 1) == 0 ? 1 : -1) * draw.log_uniform(1e-16, 1);
  const double near = draw.whole(0, 1) == 0 ? std::abs(a - b) : a + b;
  const double c = draw.whole(0, 2) == 0 ? (a + b) * draw.log_uniform(1e-20, 1e7) : std::max(0.0, near * (1 + off));
  return {a, b, c};
}

std::vector<TwoSpheres> edges(const std::vector<double>& radii) {
  std::vector<TwoSpheres> cases;
  for (const double a : radii) {
    for (const double c : {0.0, 1e-9, 0.3, 50.0, 1e9}) cases.push_back({a, 1, c});
    for (const double limit : {std::abs(a - 1), a + 1})
      for (const double c : {std::nextafter(limit, 0.0), limit, std::nextafter(limit, 1e300)})
        cases.push_back({a, 1, c});
  }
  return cases;
}

}  // namespace

TEST_SUITE("reference value") {
  TEST_CASE("hard cases of the share of both spheres: near containment and tangency, equal radii, far away") {
    Ledger ledger =
        on_random_inputs(5, few / 4, [](Draw& draw, Ledger& l) { compare_by_chords(random_case(draw, 1e200), l); });
    for (const TwoSpheres& it : edges({1e-12, 1e-3, 0.5, 1 - 0x1p-53, 1, 1 + 0x1p-52, 3, 1e6}))
      compare_by_chords(it, ledger);
    for (const TwoSpheres& it :
         {TwoSpheres{1e300, 1e300, 1e-300}, TwoSpheres{1e-300, 1e-300, 1e300}, TwoSpheres{1e300, 1e-300, 1e300},
          TwoSpheres{1e-300, 1e300, 1e300}, TwoSpheres{1e-100, 1, 1}, TwoSpheres{5e-324, 5e-324, 5e-324}})
      compare_by_chords(it, ledger);
    for (const TwoSpheres& it :
         {TwoSpheres{1, 0.7, 0.31}, TwoSpheres{1, 1, 1e-3}, TwoSpheres{0.2, 1, 1.2}, TwoSpheres{2, 1, 40}})
      compare_by_lenses(it, ledger);
    require_right(ledger);
  }
}

TEST_SUITE("hard-cases") {
  TEST_CASE("share of both spheres") {
    Ledger ledger =
        on_random_inputs(5, many / 50, [](Draw& draw, Ledger& l) { compare_by_chords(random_case(draw, 1e200), l); });
    ledger.merge(
        on_random_inputs(6, 200, [](Draw& draw, Ledger& l) { compare_by_lenses(random_case(draw, 1e12), l); }));
    for (const TwoSpheres& it : edges({1e-9, 0.5, 1, 3})) compare_by_lenses(it, ledger);
    require_right_and_print(ledger);
  }
}
