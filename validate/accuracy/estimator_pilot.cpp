#include <algorithm>
#include <cmath>

#include "accuracy_pilot.hpp"

/// What a pilot says of settings between those that it tried.
namespace detp::validate {
namespace {

/// The settings on both sides of a scale, and the share of the upper one.
struct Between {
  const SettingPilot& low;
  const SettingPilot& high;
  double share;

  template <class Value>
  [[nodiscard]] double mixed(const Value& value) const {
    return (1 - share) * value(low) + share * value(high);
  }
  /// Linear in the logarithm.
  template <class Value>
  [[nodiscard]] double log_mixed(const Value& value) const {
    return std::exp(mixed([&](const SettingPilot& one) { return std::log(value(one)); }));
  }
  [[nodiscard]] Estimate mixed_estimate(Estimate SettingPilot::*of) const {
    return {mixed([of](const SettingPilot& one) { return (one.*of).mean; }),
            mixed([of](const SettingPilot& one) { return (one.*of).standard_error; })};
  }
};

Between settings_around(const std::vector<SettingPilot>& settings, double scale) {
  if (settings.size() == 1 || scale <= settings.front().scale) return {settings.front(), settings.front(), 0};
  for (std::size_t i = 1; i < settings.size(); ++i)
    if (scale <= settings[i].scale) {
      const double step = std::log(settings[i].scale / settings[i - 1].scale);
      return {settings[i - 1], settings[i], std::log(scale / settings[i - 1].scale) / step};
    }
  return {settings.back(), settings.back(), 0};
}

double noise_of_a_ray(const SettingPilot& one) { return std::max(one.noise_squared_times_rays.mean, 1e-300); }

}  // namespace

GrowingSeconds EstimatorPilot::seconds(double scale) const {
  const Between there = settings_around(settings, scale);
  const auto mixed = [&](double GrowingSeconds::*part) {
    const auto value = [part](const SettingPilot& one) { return one.seconds.*part; };
    const bool both = value(there.low) > 0 && value(there.high) > 0;
    return both ? there.log_mixed(value) : there.mixed(value);
  };
  return {mixed(&GrowingSeconds::fixed), mixed(&GrowingSeconds::per_ray), mixed(&GrowingSeconds::per_ray_squared)};
}

double EstimatorPilot::rare_photons(double scale) const {
  return settings_around(settings, scale).log_mixed([](const SettingPilot& one) { return one.rare_photons; });
}

double EstimatorPilot::noise_squared(double scale, double rays) const {
  return settings_around(settings, scale).log_mixed(noise_of_a_ray) / rays;
}

double EstimatorPilot::noise_squared_error(double scale) const {
  // the spread of a few runs does not show what rare photons may bring
  const auto relative = [](const SettingPilot& one) {
    return std::max(one.noise_squared_times_rays.standard_error / noise_of_a_ray(one), std::sqrt(1 / one.rare_photons));
  };
  return std::sqrt(static_cast<double>(runs) + 1) * settings_around(settings, scale).mixed(relative);
}

Estimate EstimatorPilot::bias_squared(double scale) const {
  const Between there = settings_around(settings, scale);
  Estimate bias = there.mixed_estimate(&SettingPilot::bias_squared);
  const auto known = [](const Estimate& one) { return one.mean > one.standard_error; };
  if (known(there.low.bias_squared) && known(there.high.bias_squared))
    bias.mean = there.log_mixed([](const SettingPilot& one) { return one.bias_squared.mean; });
  return bias;
}

Estimate EstimatorPilot::mean_bias(double scale) const {
  return settings_around(settings, scale).mixed_estimate(&SettingPilot::mean_bias);
}

}  // namespace detp::validate
