// Makes model/sphere_cache/rebuild_law_tables.inc and model/sphere_cache/listed_rays_tables.inc: the number of rebuilds
// of the spheres of a cache along the Morton curve (in the paper: Lebesgue curve), and the share of the rays through a
// sphere that are missing in its list.
//
//   cmake --build build --target rebuild_law_table
//   build/rebuild_law_table rebuilds > model/sphere_cache/rebuild_law_tables.inc      (fifteen minutes)
//   build/rebuild_law_table coarse       (five minutes: only the second of the tables of rebuilds)
//   build/rebuild_law_table lists > model/sphere_cache/listed_rays_tables.inc         (ten minutes)
//   build/rebuild_law_table counted      (half a minute: rows of tests/model/sphere_cache/sphere_cache.test.cpp)
//
// Walks as the sphere cache does, with samples uniform in the cube [-1, 1]³ (D = 3) or on its faces (D = 2), sorted
// along the curve. A ball is centred at a sample, and stays there while this ball and all balls around it contain the
// next samples. Each table of rebuilds has values for D = 2, then for D = 3; m is the number of rebuilds, n the number
// of samples, ρ the ball's radius, and h = log₂(2/ρ) the number of halvings from the cube's side to ρ:
//   single   ln(m/n) of small balls alone: a row for each λ 2^{Dφ} = 2⁻⁹, 2⁻⁸ … 2¹³ with λ = n ρ^D/extent. A row has 32
//            values, for φ = 0, 1/32 … 31/32; φ is the fractional part of h
//   coarse   ln m of large balls alone, for n = 10³, 10^3¼ … 10⁷ by h from -1 to 4.5 in steps of 1/64; printed as
//            500 ln m in two digits of base 90. n needs four values a decade: for a ball that just contains a cell of
//            the curve, m doubles within little more than a decade
//   chain    rebuilds m_i of a ball in a nest of the ratio 2^{-u}, for n = 10³ … 10⁷ by h from 0.5 in steps of 1/32,
//            then by u: m_i = m_{i-1} + s exp(-b m_{i-1}/s) (1 - m_{i-1}/n), where m_{i-1} are the rebuilds of the next
//            larger ball and s those of the ball alone; b is printed as the digit 90 b/(1 + b).
//
// Digits of base 90 are the characters from '#' on, without the question mark and the backslash.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include "listed_rays_table.hpp"
#include "sample_walk.hpp"

namespace {

using namespace detp::tables;

constexpr int phases = 32;
constexpr std::uint64_t seed = 20261121;
constexpr std::array sample_counts{1'000UL, 10'000UL, 100'000UL, 1'000'000UL, 10'000'000UL};
constexpr std::array chain_steps{2,  3,  4,  5,  6,  7,  8,  10, 12, 14, 16, 18,
                                 20, 22, 24, 26, 28, 30, 32, 36, 40, 48, 56, 72};  // u, in units of 1/32

char digit(long value) {
  const auto plain = static_cast<char>('#' + value);
  const auto place = static_cast<char>(plain < '?' ? plain : plain + 1);
  return place < '\\' ? place : static_cast<char>(place + 1);
}

double balls(const Points& walk, double radius) { return moves(walk, {radius}).front(); }

/// Sets of `samples` samples each, with about `in_all` samples in total; 1 to 400 sets.
std::vector<Points> sets_with(int dimension, std::size_t samples, std::size_t in_all) {
  return sets_of(dimension, samples, std::clamp<std::size_t>(in_all / samples, 1, 400), seed);
}

/// ln(m/n) of a ball alone. The ball's radius is at most 1/8 of the cube's side, so that the cube's faces matter
/// little. There are at least 2²⁰ samples.
class SingleBall {
 public:
  double log_share(int dimension, int row, int phase) {
    const double halvings_to_row = std::log2(std::pow(side, dimension) / extent_of(dimension));
    int halvings = 3;
    while (row + dimension * halvings - halvings_to_row < 20) ++halvings;
    const auto samples = static_cast<std::size_t>(std::round(std::exp2(row + dimension * halvings - halvings_to_row)));
    auto& sets = sets_[{dimension, samples}];
    if (sets.empty()) sets = sets_with(dimension, samples, 4 * samples);
    double sum = 0;
    for (const Points& walk : sets) sum += balls(walk, side * std::exp2(-halvings - phase / double(phases)));
    return std::log(sum / static_cast<double>(samples * sets.size()));
  }

 private:
  std::map<std::pair<int, std::size_t>, std::vector<Points>> sets_;
};

void print_single() {
  SingleBall single;
  for (const int dimension : {2, 3})
    for (int row = -9; row <= 13; ++row) {
      for (int phase = 0; phase < phases; ++phase) fmt::print("{:.4f},", single.log_share(dimension, row, phase));
      fmt::print("\n");
    }
}

void print_coarse() {
  constexpr int steps = 64;  // per halving: the counts jump where a ball just contains a cell of the curve
  for (const int dimension : {2, 3})
    for (int column = 0; column <= 16; ++column) {
      const auto samples = static_cast<std::size_t>(std::llround(std::pow(10, 3 + column / 4.)));
      const std::vector<Points> sets = sets_with(dimension, samples, 10'000'000);
      for (int step = -steps; step <= 9 * steps / 2; ++step) {
        double sum = 0;
        for (const Points& walk : sets) sum += balls(walk, side * std::exp2(-step / double(steps)));
        const long value = std::lround(500 * std::log(sum / static_cast<double>(sets.size())));
        if ((step + steps) % 48 == 0) fmt::print("{}\"", step == -steps ? "" : "\"\n");
        fmt::print("{}{}", digit(value / 90), digit(value % 90));
      }
      fmt::print("\"\n");
    }
}

/// The table `chain`: for each size of ball and each ratio of the nest, the rebuilds that the ball has besides those of
/// the next larger ball.
class Chain {
 public:
  Chain(int dimension, std::size_t samples)
      : samples_(static_cast<double>(samples)), steps_(steps_of(dimension, samples)) {
    outer_.resize(static_cast<std::size_t>(steps_));
    nested_.resize(outer_.size());
    alone_.resize(outer_.size());
    const std::vector<Points> sets = sets_with(dimension, samples, 4'000'000);
    for (const Points& walk : sets) {
      for (int step = 0; step < steps_; ++step) alone_[static_cast<std::size_t>(step)] += balls(walk, radius(step));
      for (std::size_t u = 0; u < chain_steps.size(); ++u)
        for (int offset = 0; offset < chain_steps[u]; ++offset) add_nest(walk, u, offset);
    }
    samples_ *= static_cast<double>(sets.size());  // all counts are sums over the sets
  }

  void print() const {
    for (int step = 0; step < steps_; ++step) {
      fmt::print("\"");
      for (std::size_t u = 0; u < chain_steps.size(); ++u) {
        int known = step;  // the largest balls are in no larger ball, so they get the values of the next smaller ones
        while (outer_[static_cast<std::size_t>(known)][u] == 0 && known + 1 < steps_) ++known;
        fmt::print("{}", character(static_cast<std::size_t>(known), u));
      }
      fmt::print("\"{}", step % 5 == 4 ? "\n" : "");
    }
    fmt::print("\n");
  }

 private:
  static constexpr int first_step = phases / 2;
  /// log₂(side/r₀), since S₀ has the radius r₀ = side √3/2: the halvings h of any ball inside S₀ are at least this
  /// many.
  static constexpr double least_halvings = 0.2075;

  /// Number of steps. They go up to h = 4.5, or for the largest number of samples, to balls with less than one sample.
  static int steps_of(int dimension, std::size_t samples) {
    const int half_halvings = samples < sample_counts.back() ? 9 : dimension == 3 ? 20 : 26;
    return half_halvings * phases / 2 + 1 - first_step;
  }

  static double halvings(int step) { return (first_step + step) / double(phases); }
  static double radius(int step) { return side * std::exp2(-halvings(step)); }

  /// Adds the counts of a nest with the ratio 2^{-u}. Its largest ball is at least half a step of u smaller than S₀.
  void add_nest(const Points& walk, std::size_t u, int offset) {
    const int apart = chain_steps[u];
    int first = offset - first_step;
    while (halvings(first) < least_halvings + 0.5 * apart / phases) first += apart;
    std::vector<double> radii;
    for (int step = first; step < steps_; step += apart) radii.push_back(radius(step));
    const std::vector<double> count = moves(walk, radii);
    for (std::size_t i = 0; i < radii.size(); ++i) {
      const int step = first + static_cast<int>(i) * apart;
      if (step < 0) continue;
      nested_[static_cast<std::size_t>(step)][u] += count[i];
      if (i > 0) outer_[static_cast<std::size_t>(step)][u] += count[i - 1];
    }
  }

  [[nodiscard]] char character(std::size_t step, std::size_t u) const {
    const double outer = outer_[step][u];
    const double own = (nested_[step][u] - outer) / (1 - outer / samples_) / alone_[step];
    const double b = outer > 0 ? std::max(0.0, -std::log(std::max(own, 1e-9)) * alone_[step] / outer) : 0;
    return digit(std::min(89L, std::lround(90 * b / (1 + b))));
  }

  double samples_;
  int steps_;
  std::vector<std::array<double, chain_steps.size()>> outer_, nested_;
  std::vector<double> alone_;
};

void print_coarse_table() {
  fmt::print("constexpr std::string_view coarse_table =\n");
  print_coarse();
  fmt::print(";\n");
}

void print_rebuilds() {
  fmt::print("constexpr std::array<double, 2 * single_rows * phases> single_table{{{{\n");
  print_single();
  fmt::print("}}}};\n\n");
  print_coarse_table();
  fmt::print("\nconstexpr std::string_view chain_table =\n");
  for (const int dimension : {2, 3})
    for (const std::size_t samples : sample_counts) Chain(dimension, samples).print();
  fmt::print(";\n");
}

}  // namespace

int main(int arguments, char** argument) {
  const std::string_view table = arguments > 1 ? argument[1] : "";
  if (table == "counted") {
    print_counted_spheres();
  } else if (table == "coarse") {
    print_coarse_table();
  } else if (table == "rebuilds" || table == "lists") {
    fmt::print("// Made by validate/tools/rebuild_law_table.cpp.\n\n");
    table == "rebuilds" ? print_rebuilds() : print_listed_rays();
  } else {
    fmt::print(stderr, "usage: rebuild_law_table rebuilds|coarse|lists|counted\n");
    return 1;
  }
}
