#pragma once

#include <array>
#include <istream>
#include <string>
#include <vector>

/// The table of tools/accuracy_study.
namespace detp::validate {

/// Radii of discs, over the mean distance of neighbouring samples: the mean edge of the mesh.
inline constexpr std::array radii_over_distance{0.25, 0.5, 1.0, 2.0};

/// Errors relative to the root mean square irradiance; intervals of 95 %. Seconds: medians of making the paths, and the time of
/// the estimator at the scene's own samples.
struct AccuracyRow {
  std::string scene;
  std::string estimator;
  double radius = 0;   ///< over the sample distance; 0: not used
  double nearest = 0;  ///< k; 0: not used
  double rays = 0;
  double photons = 0;
  double noise = 0, noise_low = 0, noise_high = 0;
  double bias = 0, bias_low = 0, bias_high = 0;
  double total = 0, total_low = 0, total_high = 0;
  double within = 0;  ///< share of the samples with an error below 5 %
  double error_95 = 0;
  double worst = 0;
  double trace_seconds = 0;
  double estimate_seconds = 0;
  std::string reference;
  double reference_error = 0;

  [[nodiscard]] double seconds() const { return trace_seconds + estimate_seconds; }
  /// "disc d/h = 0.5", "nearest k = 50".
  [[nodiscard]] std::string setting() const;
};

[[nodiscard]] std::string accuracy_header();
[[nodiscard]] std::string csv_row(const AccuracyRow& row);
/// Throws std::invalid_argument for a table of another kind.
[[nodiscard]] std::vector<AccuracyRow> read_accuracy_rows(std::istream& csv);

/// Expected total error with so many rays: bias² + noise² (row's rays / rays).
[[nodiscard]] double total_with(const AccuracyRow& row, double rays);

/// Markdown: for each scene and estimator the setting with the least total error with 10⁶ rays and in one second, and discs of
/// half the sample distance beside them.
[[nodiscard]] std::string accuracy_summary(const std::vector<AccuracyRow>& rows);

}  // namespace detp::validate
