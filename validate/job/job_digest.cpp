#include "job_digest.hpp"

#include "detp/validate/base/digest.hpp"

namespace detp::validate {

std::string digest_of(const Job& job) {
  Digest digest;
  digest.add(job.seed);
  digest.add(job.independent_photons());
  for (const sim::Disc& disc : job.discs) {
    digest.add(disc.centre);
    digest.add(disc.normal);
    digest.add(disc.radius);
  }
  for (const sim::Ray& ray : job.rays) {
    digest.add(ray.origin);
    digest.add(ray.direction);
    digest.add(ray.length);
    digest.add(ray.power);
  }
  for (const std::uint64_t photon : job.photons) digest.add(photon);
  return digest.text();
}

}  // namespace detp::validate
