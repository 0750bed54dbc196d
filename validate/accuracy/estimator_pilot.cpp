#include <algorithm>
#include <cmath>

#include "accuracy_pilot.hpp"

/// What a pilot says of settings between those that it tried.
namespace detp::validate {
namespace {

/// The settings on both sides of the scale, and the share of the upper one.
struct Between {
  const SettingPilot& low;
  const SettingPilot& high;
  double share;
};

Between between(const std::vector<SettingPilot>& settings, double scale) {
  if (settings.size() == 1 || scale <= settings.front().scale) return {settings.front(), settings.front(), 0};
  for (std::size_t i = 1; i < settings.size(); ++i)
    if (scale <= settings[i].scale) {
      const double step = std::log(settings[i].scale / settings[i - 1].scale);
      return {settings[i - 1], settings[i], std::log(scale / settings[i - 1].scale) / step};
    }
  return {settings.back(), settings.back(), 0};
}

}  // namespace

GrowingSeconds EstimatorPilot::seconds(double scale) const {
  const auto [low, high, share] = between(settings, scale);
  const auto mixed = [share = share](double a, double b) {
    return a > 0 && b > 0 ? std::exp((1 - share) * std::log(a) + share * std::log(b)) : (1 - share) * a + share * b;
  };
  const GrowingSeconds& a = low.seconds;
  const GrowingSeconds& b = high.seconds;
  return {mixed(a.fixed, b.fixed), mixed(a.per_ray, b.per_ray), mixed(a.per_ray_squared, b.per_ray_squared)};
}

double EstimatorPilot::rare_photons(double scale) const {
  const auto [low, high, share] = between(settings, scale);
  return std::exp((1 - share) * std::log(low.rare_photons) + share * std::log(high.rare_photons));
}

double EstimatorPilot::noise_squared(double scale, double rays) const {
  const auto [low, high, share] = between(settings, scale);
  const auto log_of = [](const SettingPilot& one) {
    return std::log(std::max(one.noise_squared_times_rays.mean, 1e-300));
  };
  return std::exp((1 - share) * log_of(low) + share * log_of(high)) / rays;
}

double EstimatorPilot::noise_squared_error(double scale) const {
  const auto [low, high, share] = between(settings, scale);
  // the spread of a few runs does not show what rare photons may bring
  const auto relative = [](const SettingPilot& one) {
    return std::max(one.noise_squared_times_rays.standard_error / std::max(one.noise_squared_times_rays.mean, 1e-300),
                    std::sqrt(1 / one.rare_photons));
  };
  return std::sqrt(static_cast<double>(runs) + 1) * ((1 - share) * relative(low) + share * relative(high));
}

Estimate EstimatorPilot::bias_squared(double scale) const {
  const auto [low, high, share] = between(settings, scale);
  const auto mixed = [share = share](double a, double b) { return (1 - share) * a + share * b; };
  const Estimate& a = low.bias_squared;
  const Estimate& b = high.bias_squared;
  const bool known = a.mean > a.standard_error && b.mean > b.standard_error;
  return {known ? std::exp(mixed(std::log(a.mean), std::log(b.mean))) : mixed(a.mean, b.mean),
          mixed(a.standard_error, b.standard_error)};
}

Estimate EstimatorPilot::mean_bias(double scale) const {
  const auto [low, high, share] = between(settings, scale);
  const auto mixed = [share = share](double a, double b) { return (1 - share) * a + share * b; };
  return {mixed(low.mean_bias.mean, high.mean_bias.mean),
          mixed(low.mean_bias.standard_error, high.mean_bias.standard_error)};
}

}  // namespace detp::validate
