/// Compares the times of the float kernels of sim/lists/simd with the machine's limits, for lists of lines and of
/// segments that just fit each cache level.
///
/// Each row has, for the repeat with the shortest CPU time: nanoseconds per test; bytes and operations per second; the
/// limit, which is the least time that the machine needs; and the limit's share of the measured time. The limit is the
/// largest of four times: operations at peak_flops, loads at load_bandwidth and stores at store_bandwidth of the
/// working set, and for culls the packing of those vectors of which at least one lane is kept. The rates are measured
/// at the start (machine_peak).
///
///   build/benchmark_kernels [OPTIONS OF GOOGLE BENCHMARK] [--instruction_set=SSE4]

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "detp/sim/lists/simd/instruction_sets.hpp"
#include "detp/sim/lists/simd/list_search.hpp"
#include "detp/sim/lists/simd/ray_blocks.hpp"
#include "detp/sim/open/uniform_discs.hpp"
#include "detp/sim/rays/line_field.hpp"
#include "kernel_table.hpp"

namespace {

using namespace detp;
using namespace detp::sim;
using namespace detp::benchmarks;

struct Level {
  const char* name;
  std::size_t rays;  ///< in a list which, together with its culled copy, fits this level
};
constexpr Level levels[] = {{"L1", 512}, {"L2", 12'288}, {"L3", 262'144}, {"memory", 4'194'304}};

double tested_bytes(bool segments) { return segments ? 6 * sizeof(float) : 4 * sizeof(float); }
int arrays(bool segments) { return segments ? 7 : 5; }

const char* name_of_rays(bool segments) { return segments ? "segments" : "lines"; }

/// The first columns of a row.
std::string label(const std::string& kernel, bool segments, const Level& level, double number, const char* unit) {
  char text[120];
  std::snprintf(text, sizeof text, "%s | %s | %s, %zu | %.0f%s", kernel.c_str(), name_of_rays(segments), level.name,
                level.rays, number, unit);
  return text;
}

/// Discs of radius 0.01 in the unit cube, lists of lines through the sphere around them, or of segments of such lines.
class Scene {
 public:
  explicit Scene(bool segments)
      : discs_(uniform_discs(Body::cube, 1, 100'000, 0.01, 1)),
        rays_(around(discs_, segments)),
        problem_(make_problem(rays_, discs_)),
        frame_(problem_),
        tree_(stream::make_disc_tree(problem_, frame_, {8, 4})),
        hits_(discs_.size()) {
    lists_ = {make_list(rays_.size()), make_list(rays_.size()), make_list(rays_.size())};
    load_rays(rays_, frame_, lists_);
  }

  /// A list of `size` rays of class 0, in the order in which they were loaded. If there are fewer than `size` rays,
  /// they are repeated.
  stream::RayList list(std::size_t size, bool segments) {
    stream::RayList list = memory_.allocate(size, segments);
    list.size = size;
    const stream::RayList& from = lists_[0];
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t j = i % from.size;
      list.id[i] = from.id[j];
      for (const auto member : {&stream::RayList::a, &stream::RayList::b, &stream::RayList::p, &stream::RayList::q})
        (list.*member)[i] = (from.*member)[j];
      if (!segments) continue;
      list.from[i] = from.from[j];
      list.to[i] = from.to[j];
    }
    return list;
  }

  stream::RayList make_list(std::size_t size) { return memory_.allocate(size, true); }

  stream::BlockSearch search(bool segments) {
    return {.problem = problem_,
            .frame = frame_,
            .tree = tree_,
            .first_ray = 0,
            .segments = segments,
            .pairs = false,
            .vectors = false,
            .hits = hits_.data(),
            .totals = nullptr};
  }

  [[nodiscard]] const std::vector<Ray>& rays() const { return rays_; }
  [[nodiscard]] const stream::Frame& frame() const { return frame_; }

 private:
  static std::vector<Ray> around(const std::vector<Disc>& discs, bool segments) {
    std::vector<Ray> rays = LineField(enclosing_sphere(discs), 2).lines(0, 1 << 18);
    if (!segments) return rays;
    for (Ray& ray : rays) {
      ray.origin -= 0.5 * ray.direction;
      ray.length = 1;
    }
    return rays;
  }

  std::vector<Disc> discs_;
  std::vector<Ray> rays_;
  Problem problem_;
  stream::Frame frame_;
  stream::DiscTree tree_;
  std::vector<stream::ClassCounts> hits_;
  stream::ListArena memory_;
  stream::RayLists lists_;
};

/// Number of boxes or spheres of one size at random places. Calls use them in turn, so that branch prediction cannot
/// learn the results.
constexpr std::size_t shapes = 1024;

struct Shapes {
  std::vector<std::array<float, 3>> centres;
  float size;
};

using Cull =
    std::function<void(const std::array<float, 3>& centre, float size, const stream::RayList&, stream::RayList&)>;

/// Mean over 64 shapes.
double kept_share(const Cull& cull, const Shapes& tried, const stream::RayList& list, stream::RayList& inside) {
  double kept = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    cull(tried.centres[i], tried.size, list, inside);
    kept += static_cast<double>(inside.size) / static_cast<double>(list.size) / 64;
  }
  return kept;
}

Shapes shapes_keeping(double share, const Cull& cull, const stream::RayList& list, stream::RayList& inside) {
  Shapes found;
  std::mt19937 draw(3);
  std::uniform_real_distribution<float> place(-0.3F, 0.3F);
  for (std::size_t i = 0; i < shapes; ++i) found.centres.push_back({place(draw), place(draw), place(draw)});
  if (share == 0) {  // far away
    for (auto& centre : found.centres) centre[0] += 20;
    return found.size = 0.01F, found;
  }
  double low = 0;
  double high = 4;
  for (int step = 0; step < 20; ++step) {
    found.size = static_cast<float>(0.5 * (low + high));
    (kept_share(cull, found, list, inside) < share ? low : high) = found.size;
  }
  if (share == 1) found.size = 10;
  return found;
}

/// The share of vectors of which the cull keeps at least one ray. Kept rays stay in the order of the list.
double kept_vectors(const Cull& cull, const Shapes& tried, const stream::RayList& list, stream::RayList& inside) {
  const std::size_t n = vector_length();
  std::size_t kept = 0;
  std::size_t all = 0;
  for (std::size_t shape = 0; shape < 64; ++shape) {
    cull(tried.centres[shape], tried.size, list, inside);
    std::size_t next = 0;
    for (std::size_t i = 0; i < list.size; i += n, ++all) {
      const std::size_t before = next;
      for (std::size_t j = i; j < std::min(i + n, list.size) && next < inside.size; ++j)
        if (inside.id[next] == list.id[j]) ++next;
      if (next > before) ++kept;
    }
  }
  return static_cast<double>(kept) / static_cast<double>(all);
}

double best_packing(int count, std::size_t size, double share) {
  return std::min({packing_time(Packing::compress, count, size, share),
                   packing_time(Packing::permute, count, size, share),
                   packing_time(Packing::pairs, count, size, share)});
}

void add_cull(const std::string& name, bool segments, const Level& level, double share, double flops, Scene& scene,
              const Cull& cull) {
  const stream::RayList list = scene.list(level.rays, segments);
  stream::RayList inside = scene.make_list(level.rays);
  // Shares are measured on the first part of the list, because they are the same for any part.
  stream::RayList sample = list;
  sample.size = std::min<std::size_t>(list.size, 12'288);
  const Shapes tried = shapes_keeping(share, cull, sample, inside);
  const auto rays = static_cast<double>(list.size);
  const double vectors = kept_vectors(cull, tried, sample, inside) * rays / static_cast<double>(vector_length());
  const double packed = share == 0 ? 0 : vectors * best_packing(arrays(segments), list.size, share);
  const double ids = vectors * static_cast<double>(vector_length() * sizeof(std::uint32_t));
  const double written = share * rays * static_cast<double>(static_cast<std::size_t>(arrays(segments)) * sizeof(float));
  const Work work{.tests = rays,
                  .flops = flops * rays,
                  .loaded = tested_bytes(segments) * rays + ids,
                  .stored = written,
                  .working_set = level.rays * sizeof(float) * static_cast<std::size_t>(arrays(segments)),
                  .packing = packed};
  add_row(label(name, segments, level, 100 * share, " %"), work, [=, next = std::size_t{0}]() mutable {
    stream::RayList to = inside;
    cull(tried.centres[next++ % shapes], tried.size, list, to);
    benchmark::DoNotOptimize(to.size);
  });
}

void add_culls(Scene& scene, bool segments, const Level& level) {
  for (const double share : {0.0, 0.02, 0.1, 0.3, 1.0}) {
    add_cull("box", segments, level, share, box_flops[segments], scene,
             [&scene, segments](const std::array<float, 3>& centre, float size, const stream::RayList& list,
                                stream::RayList& inside) {
               static stream::Worker worker;
               const stream::TreeNode node{.centre = {centre[0], centre[1], centre[2]},
                                           .half = {size, size, size},
                                           .first = 0,
                                           .count = 0,
                                           .leaf = 0};
               const stream::ArenaScope scope(worker.lists);
               inside.size = cull_node(scene.search(segments), node, {list, {}, {}}, worker)[0].size;
             });
    add_cull("sphere", segments, level, share, sphere_flops[segments], scene,
             [&scene, segments](const std::array<float, 3>& centre, float size, const stream::RayList& list,
                                stream::RayList& inside) {
               static stream::Worker worker;
               cull_sphere(scene.search(segments), 0, {{centre[0], centre[1], centre[2]}, size}, list, inside, worker);
             });
  }
}

void add_disc_tests(Scene& scene, bool segments, const Level& level, std::uint32_t discs) {
  const stream::RayList list = scene.list(level.rays, segments);
  const double tests = static_cast<double>(list.size) * discs;
  const double vectors = static_cast<double>(list.size) / static_cast<double>(vector_length());
  const Work work{.tests = tests,
                  .flops = disc_flops[segments] * tests,
                  .loaded = tested_bytes(segments) * static_cast<double>(list.size) +
                            vectors * discs * static_cast<double>(sizeof(stream::FloatDisc)),
                  .stored = 0,
                  .working_set = level.rays * sizeof(float) * static_cast<std::size_t>(arrays(segments)),
                  .packing = 0};
  add_row(label("disc", segments, level, discs, " discs"), work, [=, &scene, first = std::uint32_t{0}]() mutable {
    static stream::Worker worker;
    test_discs(scene.search(segments), 0, first % 4096, discs, list, worker);
    first += discs;
  });
}

void add_loading(Scene& scene, bool segments, std::size_t size) {
  const stream::RayLists lists{scene.make_list(size), scene.make_list(size), scene.make_list(size)};
  const auto rays = static_cast<double>(size);
  const Work work{.tests = rays,
                  .flops = load_flops * rays,
                  .loaded = rays * sizeof(Ray),
                  .stored = rays * 7 * sizeof(float),
                  .working_set = size * sizeof(Ray),
                  .packing = 0};
  add_row(std::string("load_rays | ") + name_of_rays(segments) + " | " + std::to_string(size) + " |", work,
          [=, &scene]() mutable {
            stream::RayLists to = lists;
            benchmark::DoNotOptimize(load_rays(std::span(scene.rays()).first(size), scene.frame(), to));
          });
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  std::optional<stream::OnlyInstructionSet> only;
  const std::string_view option = "--instruction_set=";
  if (argc > 1 && std::string_view(argv[argc - 1]).starts_with(option)) only.emplace(argv[--argc] + option.size());
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Scene scenes[] = {Scene(false), Scene(true)};
  for (const bool segments : {false, true}) {
    for (const Level& level : levels) {
      add_culls(scenes[segments], segments, level);
      for (const std::uint32_t discs : {4U, 16U, 64U}) add_disc_tests(scenes[segments], segments, level, discs);
    }
    for (const std::size_t size : {std::size_t{4096}, std::size_t{131'072}})
      add_loading(scenes[segments], segments, size);
  }
  print_peaks();
  run_rows();
}
