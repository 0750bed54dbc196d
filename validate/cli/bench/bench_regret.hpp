#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "detp/validate/cli/options/common_options.hpp"
#include "detp/validate/cli/options/costs_in_use.hpp"
#include "detp/validate/cli/text/result.hpp"

/// `bench --regret`.
namespace detp::cli {

class RegretCommand {
 public:
  /// Adds --regret, --families, --costs and --calibration.
  void add_to(CLI::App& bench);

  /// Whether --regret was given. Throws std::invalid_argument if options were given that it excludes.
  [[nodiscard]] bool is_wanted() const;

  /// Seed of the families of scenes that replace the other workloads.
  [[nodiscard]] std::optional<std::uint64_t> families() const { return families_; }
  [[nodiscard]] CostsInUse costs(const CommonOptions& common) const { return costs_.costs(common); }

 private:
  bool wanted_ = false;
  std::optional<std::uint64_t> families_;
  CostOptions costs_;
  const CLI::App* bench_ = nullptr;
};

/// The regret of the choices over the workloads of the effort: "quick" or "thorough". With a scene or fields, only over
/// those of them. Throws std::invalid_argument if there are none.
[[nodiscard]] Result run_bench_regret(const RegretCommand& command, const std::string& effort,
                                      const std::optional<std::string>& scene, const std::vector<std::string>& fields,
                                      const CommonOptions& common, const std::stop_token& stop);

}  // namespace detp::cli
