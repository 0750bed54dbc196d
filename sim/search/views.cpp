#include "views.hpp"

#include <stdexcept>
#include <string>

#include "detp/model/vocabulary/vocabulary.hpp"
#include "detp/sim/base/memory.hpp"
#include "detp/sim/base/parallel.hpp"
#include "detp/sim/base/threads.hpp"
#include "soundness.hpp"

namespace detp::sim {
namespace {

template <class T>
glm::dvec3 vector_at(const VectorsView& view, std::size_t i) {
  return {view.get<T>(i, 0), view.get<T>(i, 1), view.get<T>(i, 2)};
}
glm::dvec3 vector_at(const VectorsView& view, std::size_t i) { return {view.at(i, 0), view.at(i, 1), view.at(i, 2)}; }

template <class Origin, class Direction>
void read_some(const RaysView& view, std::size_t first, std::span<Ray> rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Ray& ray = rays[i];
    ray.origin = vector_at<Origin>(view.origins, first + i);
    ray.direction = normalised(vector_at<Direction>(view.directions, first + i));
    ray.length = view.lengths[first + i];
    ray.power = view.powers[first + i];
  }
}

template <class View>
void require_array(const char* what, const View& view) {
  if (!view.exists()) throw std::invalid_argument(std::string("the array of ") + what + " is null");
}

}  // namespace

void read_rays(const RaysView& view, std::size_t first, std::span<Ray> rays, int threads) {
  constexpr std::size_t at_once = 4096;
  const DefaultFloatingPoint mode;
  require_count("number of threads", threads, 0, most_threads);
  if (!rays.empty()) {
    require_array("origins", view.origins);
    require_array("directions", view.directions);
    require_array("lengths", view.lengths);
    require_array("powers", view.powers);
  }
  const auto read = view.origins.floats()
                        ? view.directions.floats() ? &read_some<float, float> : &read_some<float, double>
                    : view.directions.floats() ? &read_some<double, float>
                                               : &read_some<double, double>;
  if (threads == 1 || rays.size() <= at_once) return read(view, first, rays);
  on_threads(thread_count(threads), [&] {
    parallel_for(ParallelRange(0, rays.size(), at_once), [&](const ParallelRange& range) {
      read(view, first + range.begin(), rays.subspan(range.begin(), range.size()));
    });
  });
}

void read_further_powers(const RaysView& view, std::size_t first, std::size_t rays, std::vector<double>& powers) {
  const std::size_t bands = view.further_powers.size();
  powers.resize(rays * bands);
  for (std::size_t band = 0; band < bands; ++band) {
    const NumbersView& from = view.further_powers[band];
    require_array("powers", from);
    for (std::size_t i = 0; i < rays; ++i) powers[i * bands + band] = from[first + i];
  }
}

Ray read_ray(const RaysView& view, std::size_t number) {
  Ray ray;
  read_rays(view, number, {&ray, 1});
  return ray;
}

std::size_t end_of_piece(const RaysView& view, std::size_t first, std::size_t most) {
  const std::size_t end = std::min(view.count, first + most);
  const auto begins_photon = [&](std::size_t ray) {
    return ray == view.photons.size() || view.photons[ray] != view.photons[ray - 1];
  };
  if (view.photons.empty()) return end;
  std::size_t whole = end;
  while (whole > first && !begins_photon(whole)) --whole;
  if (whole > first) return whole;
  for (whole = end; !begins_photon(whole);) ++whole;
  return whole;
}

std::vector<Disc> read_discs(const DiscsView& view) {
  const DefaultFloatingPoint mode;
  if (view.count > 0) {
    require_array("centres", view.centres);
    require_array("normals", view.normals);
    require_array("radii", view.radii);
  }
  require_memory("the discs", static_cast<double>(view.count) * sizeof(Disc));
  std::vector<Disc> discs(view.count);
  for (std::size_t i = 0; i < view.count; ++i)
    discs[i] = normalised(Disc{vector_at(view.centres, i), vector_at(view.normals, i), view.radii[i]});
  return discs;
}

}  // namespace detp::sim
