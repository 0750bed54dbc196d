#include "checkpoint.hpp"

#include <utility>

#include "detp/validate/checkpoint/estimate_json.hpp"

namespace detp::validate {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Deviation, dimension, samples, disc_share, technique, parameters, quantity, sphere,
                                   form, predicted, observed)

Checkpoint::Checkpoint(std::filesystem::path path, std::uint64_t seed, const std::string& formulas)
    : file_(std::move(path), "validate --effort thorough",
            {{"seed", seed}, {"digest of formulas and workloads", formulas}}) {}

void Checkpoint::read(std::stop_token stop) {
  const auto state = file_.read(std::move(stop));
  if (!state) return;
  try {
    state->get_to(points_);
  } catch (const nlohmann::json::exception& error) {
    throw file_.damaged(error.what());
  }
}

void Checkpoint::add(const std::string& point, const std::vector<Deviation>& deviations) {
  points_[point] = deviations;
  file_.write(points_);
}

}  // namespace detp::validate
