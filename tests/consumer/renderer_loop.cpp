// A renderer's loop: photon segments, frame after frame, become the irradiance at fixed samples.
#include <cstdio>
#include <cstdlib>
#include <detp/detp.hpp>

struct Sample {  // as a renderer keeps them
  float position[3], normal[3];
};
struct Segment {
  float origin[3], direction[3], length, power[3];  // red, green, blue
};

int main() {
  const auto random = [] { return static_cast<float>(std::rand()) / static_cast<float>(RAND_MAX); };
  std::vector<Sample> floor(10'000);
  for (Sample& sample : floor) sample = {{random(), random(), 0}, {0, 0, 1}};
  const detp::sim::DiscsView discs{
      floor.size(), {floor[0].position, sizeof(Sample)}, {floor[0].normal, sizeof(Sample)}, 0.02};
  std::vector<Segment> photons(20'000);  // from a square lamp one unit above the floor
  detp::sim::RaysView rays{photons.size(),
                           {photons[0].origin, sizeof(Segment)},
                           {photons[0].direction, sizeof(Segment)},
                           {&photons[0].length, sizeof(Segment)}};
  rays.set_powers(photons[0].power, 3, sizeof(Segment));  // one search finds the irradiance in all three
  const auto trace_photons = [&] {
    for (Segment& s : photons)
      s = {{random(), random(), 1}, {random() - 0.5F, random() - 0.5F, -1}, 9, {6e-5F, 5e-5F, 3e-5F}};
  };

  // What an operation costs on this machine: as detp calibrate stored it, or measured now, roughly.
  const auto stored = detp::validate::stored_calibration();
  const detp::CostTable costs = stored ? stored->simd : detp::validate::calibrate({.seconds = 1}).simd;

  trace_photons();
  // Technique and parameters, chosen by a pilot; the samples, sorted once.
  const auto show = [](const detp::sim::Phase& phase) {
    std::printf("%3.0f %% %s\n", 100 * phase.from, phase.what.c_str());
  };
  detp::validate::Plan plan = detp::validate::plan(discs, rays, {.costs = costs, .progress = show});
  detp::sim::SearchScratch scratch;
  double radius = 0.02;
  for (int pass = 0; pass < 4; ++pass, radius *= 0.8) {  // new photons and a smaller radius in each pass
    if (pass > 0) plan = detp::validate::replan(plan, radius);
    trace_photons();
    const detp::sim::Outcome& found =
        detp::validate::execute(plan, rays, scratch, {.count = false, .standard_error = true});
    std::printf("radius %.3f, %s, predicted %.2g ms: %llu hits; irradiance of sample 0:", radius,
                detp::title(plan.candidate()).c_str(), 1e3 * plan.predicted_seconds(),
                static_cast<unsigned long long>(found.total_hits));
    for (std::size_t band = 0; band < found.bands(); ++band)
      std::printf(" %.3f +- %.3f", found.band(band).irradiance[0], found.band(band).standard_error[0]);
    std::printf("\n");
    if (found.total_hits == 0) return 1;
  }
}
