#include "types.hpp"

#include <cmath>
#include <limits>

#include "guard.hpp"

namespace detp::c {
namespace {

void check_type(int type, const std::string& name) {
  if (type != DETP_FLOAT && type != DETP_DOUBLE)
    throw std::invalid_argument(name + ": type must be DETP_FLOAT or DETP_DOUBLE (got " + std::to_string(type) + ")");
}

template <class T>
sim::VectorsView typed_vectors(const detp_vectors& vectors) {
  const auto at = [](const void* data) { return static_cast<const T*>(data); };
  if (vectors.y == nullptr) return {at(vectors.x), vectors.stride != 0 ? vectors.stride : 3 * sizeof(T)};
  return {at(vectors.x), at(vectors.y), at(vectors.z), vectors.stride != 0 ? vectors.stride : sizeof(T)};
}

/// Throws std::length_error if no process could have arrays of so many elements.
void check_count(std::size_t count, const char* name) {
  constexpr std::size_t most = std::size_t{1} << 43;  // of 12 bytes or more, in addresses of 47 bits
  if (count > most)
    throw std::length_error(std::string(name) + ": count must be at most 2^43 (got " + std::to_string(count) + ")");
}

sim::VectorsView vectors_of(const detp_vectors& vectors, std::size_t count, const std::string& name) {
  check_type(vectors.type, name);
  if (count > 0 && vectors.x == nullptr) throw std::invalid_argument(name + ": x is null");
  if ((vectors.y == nullptr) != (vectors.z == nullptr))
    throw std::invalid_argument(name + ": y and z must both be arrays, or both be null");
  return vectors.type == DETP_FLOAT ? typed_vectors<float>(vectors) : typed_vectors<double>(vectors);
}

sim::NumbersView numbers_of(const detp_numbers& numbers, const std::string& name, double usual) {
  check_type(numbers.type, name);
  if (numbers.data == nullptr) return numbers.of_all == 0 ? usual : numbers.of_all;
  if (numbers.type == DETP_FLOAT)
    return {static_cast<const float*>(numbers.data), numbers.stride != 0 ? numbers.stride : sizeof(float)};
  return {static_cast<const double*>(numbers.data), numbers.stride != 0 ? numbers.stride : sizeof(double)};
}

}  // namespace

sim::RaysView view_of(const detp_rays* given_rays) {
  const detp_rays rays = known(given_rays, "rays");
  check_count(rays.count, "rays");
  sim::RaysView view{.count = rays.count,
                     .origins = vectors_of(rays.origins, rays.count, "rays.origins"),
                     .directions = vectors_of(rays.directions, rays.count, "rays.directions"),
                     .lengths = numbers_of(rays.lengths, "rays.lengths", sim::unbounded),
                     .powers = numbers_of(rays.powers, "rays.powers", 1)};
  if (rays.photons != nullptr) view.photons = {rays.photons, rays.count};
  if (rays.further_bands >= sim::most_bands)
    throw std::invalid_argument("rays: there are " + std::to_string(rays.further_bands) +
                                " further bands; the maximum is " + std::to_string(sim::most_bands - 1));
  if (rays.further_bands > 0) given(rays.further_powers, "rays.further_powers");
  for (std::size_t band = 0; band < rays.further_bands; ++band)
    view.further_powers.push_back(
        numbers_of(rays.further_powers[band], "rays.further_powers[" + std::to_string(band) + "]", 1));
  return view;
}

sim::DiscsView view_of(const detp_discs* given_discs) {
  const detp_discs discs = known(given_discs, "discs");
  check_count(discs.count, "discs");
  return {.count = discs.count,
          .centres = vectors_of(discs.centres, discs.count, "discs.centres"),
          .normals = vectors_of(discs.normals, discs.count, "discs.normals"),
          .radii = numbers_of(discs.radii, "discs.radii", 0)};
}

}  // namespace detp::c
