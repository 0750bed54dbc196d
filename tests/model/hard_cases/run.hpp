#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <mpfr.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/geometry/random.hpp"
#include "support/high_precision.hpp"
#include "support/random_workload.hpp"

/// Formulas on random inputs, compared with 100 digits.
namespace detp::hard_cases {

// Random inputs from the whole domain of the formulas. An input depends only on its family and index, not on threads.

/// The 64-bit words of one index.
class Words {
 public:
  Words(std::uint64_t family, std::uint64_t index) : family_(family), index_(index) {}

  std::uint64_t operator()() {
    if (next_ % 4 == 0) words_ = sim::bits4(family_, sim::Stream::tests, index_, next_ / 4);
    return words_[next_++ % 4];
  }

 private:
  std::uint64_t family_;
  std::uint64_t index_;
  std::uint64_t next_ = 0;
  std::array<std::uint64_t, 4> words_{};
};

class Draw : public support::NumbersFrom<Words> {
 public:
  Draw(std::uint64_t family, std::uint64_t index) : NumbersFrom(Words(family, index)) {}

  /// Q in (0, 1), one third each: 1 - Q log-uniform down to 2⁻⁵³; Q log-uniform down to 2⁻¹⁰⁷⁴; Q uniform.
  double ratio() {
    const std::int64_t kind = whole(0, 2);
    const double q = kind == 0 ? 1 - log_uniform(0x1p-54, 1) : kind == 1 ? log_uniform(5e-324, 1) : uniform(0, 1);
    return std::clamp(q, std::numeric_limits<double>::denorm_min(), 1 - 0x1p-53);
  }

  /// n_R or n_P.
  double rays_or_samples() { return std::max(1.0, count(1, 1e18)); }

  /// An index of a sphere, 1 … 9e18: log-uniform, or such that Qⁱ is spread over the range of doubles.
  std::int64_t index(double ratio) {
    const double most = 9e18;
    const double i = whole(0, 1) == 0 ? log_uniform(1, most) : uniform(0, 745) / -std::log(ratio);
    return static_cast<std::int64_t>(std::clamp(std::ceil(i), 1.0, most));
  }

  /// A time or another factor: mostly within 1e±12, otherwise anywhere in the range of doubles.
  double factor() { return whole(0, 3) > 0 ? log_uniform(1e-12, 1e12) : anywhere(); }

  /// A positive normal double, log-uniform.
  double anywhere() { return log_uniform(1e-307, 1e308); }

  /// n_R rays, n_P samples, d/r₀ from 1e-300 to 1 and occasionally above, r₀ within 1e±90.
  Workload workload() {
    const double outer = log_uniform(1e-90, 1e90);
    const double longest = std::clamp(outer * uniform(0.5, 1.2), 1e-90, 1e90);
    return {
        .rays = rays_or_samples(),
        .samples = rays_or_samples(),
        .disc_radius = outer * (whole(0, 9) == 0 ? log_uniform(1, 10) : log_uniform(1e-300 / std::min(1.0, outer), 1)),
        .sphere_radius = outer,
        .box = {longest, longest * uniform(0, 1), longest * log_uniform(1e-12, 1)}};
  }
};

// Records the errors of formulas.

using support::Exact;

/// The largest error allowed for a formula for which the test gives no smaller one.
inline constexpr double allowed = 1e-13;

/// One formula: the number of its inputs, and its largest error.
struct Entry {
  std::uint64_t inputs = 0;
  double worst = -1;  ///< relative error
  std::string where;  ///< inputs, expected and computed value of the largest error
};

/// Compares values with exact ones. `describe` returns the inputs as text; it is only called if the text is kept.
class Ledger {
 public:
  template <class Describe>
  void compare(const char* formula, double value, const Exact& exact, const Describe& describe, double most = allowed) {
    record(
        formula, support::relative_error(value, exact),
        [&] {
          return fmt::format("{}: expected {}, got {:.17g}", describe(), exact.str(25, std::ios_base::scientific),
                             value);
        },
        most);
  }

  /// Records a whole number, which is right (error 0) or wrong (error 1).
  template <class Describe>
  void compare_whole(const char* formula, std::int64_t value, bool right, const Describe& describe) {
    record(formula, right ? 0 : 1, [&] { return fmt::format("{}: got {}", describe(), value); });
  }

  void merge(const Ledger& other) {
    for (const auto& [formula, theirs] : other.entries_) {
      Entry& ours = entries_[formula];
      ours.inputs += theirs.inputs;
      if (theirs.worst > ours.worst) {
        ours.worst = theirs.worst;
        ours.where = theirs.where;
      }
    }
    failures_ += other.failures_;
    for (const std::string& text : other.shown_)
      if (shown_.size() < most_shown) shown_.push_back(text);
  }

  [[nodiscard]] const std::map<std::string, Entry>& entries() const { return entries_; }
  [[nodiscard]] std::uint64_t failures() const { return failures_; }

  /// The first failures in full.
  [[nodiscard]] std::string report() const {
    std::string text = fmt::format("{} values are off by more than is allowed", failures_);
    for (const std::string& failure : shown_) text += "\n  " + failure;
    return text;
  }

  /// One line for each formula: name, inputs, largest relative error, where.
  [[nodiscard]] std::string table() const {
    std::string text;
    for (const auto& [formula, entry] : entries_)
      text += fmt::format("{:<40} {:>9} {:>9.2g}  {}\n", formula, entry.inputs, entry.worst,
                          entry.worst > 0 ? "at " + entry.where : "");
    return text;
  }

 private:
  static constexpr std::size_t most_shown = 12;

  template <class Where>
  void record(const char* formula, double error, const Where& where, double most = allowed) {
    Entry& entry = entries_[formula];
    ++entry.inputs;
    if (error > entry.worst) {
      entry.worst = error;
      entry.where = where();
    }
    if (error <= most) return;
    ++failures_;
    if (shown_.size() < most_shown) shown_.push_back(fmt::format("{} off by {:.3g} at {}", formula, error, where()));
  }

  std::map<std::string, Entry> entries_;
  std::uint64_t failures_ = 0;
  std::vector<std::string> shown_;
};

// Runs a check on many random inputs, on all cores, and compares the ledger with the allowed error.

inline constexpr std::uint64_t few = 2'000;       ///< in the quick suite
inline constexpr std::uint64_t many = 1'000'000;  ///< in the suite "hard-cases"

/// Calls check(draw, ledger) for the inputs 0 … inputs - 1 of a family. Rethrows an exception of check.
template <class Check>
[[nodiscard]] Ledger on_random_inputs(std::uint64_t family, std::uint64_t inputs, const Check& check) {
  const std::uint64_t threads = std::min<std::uint64_t>(std::max(1U, std::thread::hardware_concurrency()), inputs);
  std::vector<Ledger> ledgers(threads);
  std::vector<std::exception_ptr> thrown(threads);
  std::vector<std::thread> running;
  for (std::uint64_t thread = 0; thread < threads; ++thread)
    running.emplace_back([&, thread] {
      try {
        for (std::uint64_t i = thread; i < inputs; i += threads) {
          Draw draw(family, i);
          check(draw, ledgers[thread]);
        }
      } catch (...) {
        thrown[thread] = std::current_exception();
      }
      mpfr_free_cache();  // MPFR keeps constants for each thread
    });
  for (std::thread& thread : running) thread.join();
  Ledger all;
  for (std::uint64_t thread = 0; thread < threads; ++thread) {
    if (thrown[thread]) std::rethrow_exception(thrown[thread]);
    all.merge(ledgers[thread]);
  }
  return all;
}

/// Fails the test, and shows the inputs, if an error is larger than allowed.
inline void require_right(const Ledger& ledger) {
  REQUIRE(!ledger.entries().empty());
  CHECK_MESSAGE(ledger.failures() == 0, ledger.report());
}

/// Fails the test if an error is larger than allowed, and prints the table to standard output; for the long suite.
inline void require_right_and_print(const Ledger& ledger) {
  fmt::print("{}", ledger.table());
  require_right(ledger);
}

}  // namespace detp::hard_cases
