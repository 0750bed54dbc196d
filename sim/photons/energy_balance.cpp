#include "energy_balance.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "photon_walk.hpp"

namespace detp::sim {
namespace {

constexpr std::uint64_t photons_in_a_sum = 4096;  // photons whose powers are summed at a time, whatever the threads
constexpr std::uint64_t work_of_a_photon = 128;   // for StopCheck

/// Sums powers. `surfaces` has an entry for each material.
struct Account {
  const Scene& scene;
  EnergyBalance balance = {};
  double squares = 0;  ///< of the powers that escaped
  std::vector<double> variances = {};

  void piece(const Ray&, double) {}

  void met(std::uint32_t triangle, double power, bool absorbed) {
    const auto& numbers = scene.mesh.materials.of_triangle;
    const std::size_t place = numbers.empty() ? 0 : numbers[triangle];
    const Material& material = scene.mesh.materials.of(triangle);
    const double share = std::clamp(1 - material.diffuse - material.specular - material.glass, 0.0, 1.0);
    SurfaceEnergy& surface = balance.surfaces[place];
    surface.arriving += power;
    surface.absorbed += absorbed ? power : 0;
    surface.expected += share * power;
    variances[place] += share * (1 - share) * power * power;
  }

  void escaped(double power) {
    balance.escaped += power;
    squares += power * power;
  }

  void cut_off(double power) { balance.cut_off += power; }
};

Account empty_account(const Scene& scene) {
  Account account{scene};
  const Materials& materials = scene.mesh.materials;
  for (const Material& material : materials.all) account.balance.surfaces.push_back({.material = material.name});
  if (materials.all.empty()) account.balance.surfaces.push_back({.material = matt.name});
  account.variances.resize(account.balance.surfaces.size());
  return account;
}

void add(Account& to, const Account& from) {
  to.balance.emitted += from.balance.emitted;
  to.balance.escaped += from.balance.escaped;
  to.balance.cut_off += from.balance.cut_off;
  to.squares += from.squares;
  for (std::size_t i = 0; i < to.variances.size(); ++i) {
    to.balance.surfaces[i].arriving += from.balance.surfaces[i].arriving;
    to.balance.surfaces[i].absorbed += from.balance.surfaces[i].absorbed;
    to.balance.surfaces[i].expected += from.balance.surfaces[i].expected;
    to.variances[i] += from.variances[i];
  }
}

}  // namespace

double EnergyBalance::absorbed() const {
  double sum = 0;
  for (const SurfaceEnergy& surface : surfaces) sum += surface.absorbed;
  return sum;
}

EnergyBalance energy_balance(const Scene& scene, std::uint64_t photons, std::uint64_t seed,
                             const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  if (photons == 0) throw std::invalid_argument("an energy balance needs at least 1 photon (got 0)");
  const PhotonWalk walk(scene, seed, stop);
  std::vector<Account> groups((photons + photons_in_a_sum - 1) / photons_in_a_sum, empty_account(scene));
  sim::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t group) {
    StopCheck check(stop, "tracing photons");
    check.now();
    const std::uint64_t first = group * photons_in_a_sum;
    for (std::uint64_t photon = first; photon < std::min(first + photons_in_a_sum, photons); ++photon) {
      groups[group].balance.emitted += walk.power(photon);
      walk.follow(photon, groups[group]);
      check.after(work_of_a_photon);
    }
  });
  Account sum = empty_account(scene);
  for (const Account& group : groups) add(sum, group);
  EnergyBalance& balance = sum.balance;
  const auto count = static_cast<double>(photons);
  balance.photons = photons;
  for (const Light& light : scene.lights) balance.flux += light.flux;
  balance.standard_error = std::sqrt(std::max(0.0, sum.squares / count - std::pow(balance.escaped / count, 2)) / count);
  for (double* value : {&balance.emitted, &balance.escaped, &balance.cut_off}) *value /= count;
  for (std::size_t i = 0; i < balance.surfaces.size(); ++i) {
    SurfaceEnergy& surface = balance.surfaces[i];
    for (double* value : {&surface.arriving, &surface.absorbed, &surface.expected}) *value /= count;
    surface.standard_error = std::sqrt(sum.variances[i]) / count;
  }
  return std::move(sum.balance);
}

}  // namespace detp::sim
