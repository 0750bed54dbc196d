#include "coincident.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "box_pairs.hpp"
#include "clip.hpp"
#include "detp/sim/base/floating_point.hpp"
#include "detp/sim/base/stop_check.hpp"
#include "plate.hpp"

namespace detp::sim {
namespace {

Box box_of_plate(const Plate& plate, double slack) {
  Box box;
  for (const glm::dvec3& corner : plate.corners) box.include(corner);
  return {box.low - slack, box.high + slack};
}

/// Whether the plane of the plate comes near the box.
bool plane_meets(const Plate& plate, const Box& box, double slack) {
  const glm::dvec3 half = 0.5 * box.size();
  const double reach = glm::dot(glm::abs(plate.normal), half);
  constexpr double rounding = 1e-14;
  return std::abs(glm::dot(plate.normal, box.low + half - plate.corners[0])) <= reach + 2 * slack + rounding;
}

/// Pairs of plates that coincide; the winner first.
std::vector<BoxPair> coincident_pairs(const Plates& plates, const std::stop_token& stop) {
  std::vector<glm::vec3> normals;  // most pairs need no more than these
  normals.reserve(plates.all.size());
  StopCheck check(stop, "joining faces in the same place");
  for_each_checked(std::span(plates.all), check,
                   [&](const Plate& plate) { normals.push_back(glm::vec3(plate.normal)); });
  const auto box = [&](std::uint32_t number) { return box_of_plate(plates.all[number], plates.slack); };
  const auto near = [&](std::uint32_t number, const Box& other) {
    return plane_meets(plates.all[number], other, plates.slack);
  };
  const auto match = [&](std::uint32_t winner, std::uint32_t other) {
    constexpr float surely_parallel = 1 - 3e-6F;
    if (std::abs(glm::dot(normals[winner], normals[other])) < surely_parallel) return false;
    return coincide(plates.all[winner], plates.all[other], plates.slack);
  };
  return box_pairs(plates.all.size(), {box, near, match}, stop);
}

/// What becomes of a triangle that does not stay as it is.
struct Change {
  std::uint32_t triangle;
  std::uint32_t plate = 0;                 ///< if there are pieces
  std::vector<LabelledPiece> pieces = {};  ///< labelled with the material of the back
};

/// For each plate its partners: those that win over it, then those that it wins over, each in rising order.
class Partners {
 public:
  Partners(std::size_t plates, std::span<const BoxPair> pairs) : first_(plates + 1), partners_(2 * pairs.size()) {
    for (const BoxPair& pair : pairs)
      for (const std::uint32_t plate : pair) ++first_[plate + 1];
    for (std::size_t i = 0; i < plates; ++i) first_[i + 1] += first_[i];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (const auto& [winner, other] : pairs) partners_[next[other]++] = winner;
    for (const auto& [winner, other] : pairs) partners_[next[winner]++] = other;
  }

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t plate) const {
    return std::span(partners_).subspan(first_[plate], first_[plate + 1] - first_[plate]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> partners_;
};

/// Finds the changes, plate by plate.
class Joining {
 public:
  Joining(const Materials& materials, const Plates& plates, StopCheck& check)
      : materials_(materials), plates_(plates), check_(check), emitting_(plates.emitting_repeated) {
    for (const std::uint32_t triangle : plates.repeated) changes_.push_back({triangle});
    joined_ = changes_.size();
  }

  void join(std::uint32_t number, std::span<const std::uint32_t> partners) {
    const Plate& plate = plates_.all[number];
    const PlateView view(plate);
    covers_.clear();
    std::size_t needed = 0;  // covers up to the last that has an effect
    bool emits_again = false;
    for (const std::uint32_t partner : partners) {
      const Plate& other = plates_.all[partner];
      const bool turned = is_turned(plate, other);
      const bool removes = partner < number;
      if (!removes && !turned) continue;
      covers_.push_back({view.flat(other), removes ? Cover::removed : label_of_back(plate, other)});
      if (covers_.back().label != no_back) needed = covers_.size();
      emits_again = emits_again || (removes && !turned && materials_.of(plate.triangle).emitted > 0);
    }
    if (needed == 0) return;
    Division division = divided(view.polygon(plate), std::span(covers_).first(needed), no_back, plates_.slack, check_);
    if (!division.is_less && division.pieces.size() == 1 && division.pieces[0].label == no_back) return;
    joined_ += division.is_less ? 1 : 0;
    emitting_ += division.is_less && emits_again ? 1 : 0;
    changes_.push_back({plate.triangle, number, std::move(division.pieces)});
  }

  [[nodiscard]] std::uint64_t joined() const { return joined_; }
  [[nodiscard]] std::uint64_t emitting() const { return emitting_; }

  /// In the order of the triangles.
  [[nodiscard]] std::vector<Change> take() && {
    std::ranges::sort(changes_, {}, &Change::triangle);
    return std::move(changes_);
  }

 private:
  /// Of a plate that wins over a turned one.
  [[nodiscard]] std::uint32_t label_of_back(const Plate& plate, const Plate& other) const {
    if (materials_.all.empty()) return no_back;
    const std::uint16_t back = materials_.number_of(other.triangle);
    const bool is_needed = back != materials_.number_of(plate.triangle) || materials_.all[back].emitted > 0;
    return is_needed ? back : no_back;
  }

  const Materials& materials_;
  const Plates& plates_;
  StopCheck& check_;
  std::vector<Cover> covers_ = {};
  std::vector<Change> changes_ = {};
  std::uint64_t joined_ = 0;    ///< triangles that lose something
  std::uint64_t emitting_ = 0;  ///< of them, to one that emits on the same side
};

/// Writes the triangles of a mesh anew, in their order.
class Rewriting {
 public:
  Rewriting(Mesh& mesh, const Plates& plates) : mesh_(mesh), plates_(plates) {
    triangles_.reserve(mesh.triangles.size());
  }

  void keep(std::uint32_t triangle) { add(triangle, mesh_.triangles[triangle], no_back); }

  void change(const Change& change) {
    if (change.pieces.empty()) return;
    const PlateView view(plates_.all[change.plate]);
    const auto& corners = mesh_.triangles[change.triangle];
    std::map<std::pair<double, double>, std::uint32_t> added;
    std::vector<std::uint32_t> fan;
    for (const LabelledPiece& piece : change.pieces) {
      fan.clear();
      for (const auto& [place, number] : without_flat_corners(piece.polygon, plates_.slack)) {
        if (number != new_corner) {
          fan.push_back(corners[number]);
          continue;
        }
        const auto [found, is_new] = added.try_emplace({place.x, place.y}, 0);
        if (is_new) found->second = add_vertex(view.point(place));
        fan.push_back(found->second);
      }
      for (std::size_t i = 1; i + 1 < fan.size(); ++i)
        add(change.triangle, {fan[0], fan[i], fan[i + 1]}, static_cast<std::uint16_t>(piece.label));
    }
  }

  void finish() {
    mesh_.triangles = std::move(triangles_);
    if (!mesh_.materials.of_triangle.empty()) mesh_.materials.of_triangle = std::move(of_triangle_);
    if (std::ranges::any_of(of_back_, [](std::uint16_t back) { return back != no_back; }))
      mesh_.materials.of_back = std::move(of_back_);
    if (!mesh_.groups.of_triangle.empty()) mesh_.groups.of_triangle = std::move(groups_);
  }

 private:
  /// A piece of the old triangle.
  void add(std::uint32_t old, const std::array<std::uint32_t, 3>& corners, std::uint16_t back) {
    triangles_.push_back(corners);
    of_triangle_.push_back(mesh_.materials.number_of(old));
    of_back_.push_back(back == no_back && mesh_.materials.has_back(old) ? mesh_.materials.of_back[old] : back);
    if (!mesh_.groups.of_triangle.empty()) groups_.push_back(mesh_.groups.of_triangle[old]);
  }

  std::uint32_t add_vertex(const glm::dvec3& scaled) {
    const auto number = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.push_back(plates_.scaled.inverse()(scaled));
    if (!mesh_.normals.empty()) mesh_.normals.push_back(glm::dvec3{0.0});
    if (mesh_.file_vertices.empty())
      for (std::uint32_t i = 0; i < number; ++i) mesh_.file_vertices.push_back(i);
    mesh_.file_vertices.push_back(no_vertex);
    return number;
  }

  Mesh& mesh_;
  const Plates& plates_;
  std::vector<std::array<std::uint32_t, 3>> triangles_ = {};
  std::vector<std::uint16_t> of_triangle_ = {};
  std::vector<std::uint16_t> of_back_ = {};
  std::vector<std::uint32_t> groups_ = {};  ///< indices into the sets
};

void rewrite(Mesh& mesh, const Plates& plates, std::span<const Change> changes, StopCheck& check) {
  Rewriting rewriting(mesh, plates);
  auto change = changes.begin();
  for_each_checked(0, mesh.triangles.size(), check, [&](std::size_t i) {
    const auto triangle = static_cast<std::uint32_t>(i);
    if (change == changes.end() || change->triangle != triangle) return rewriting.keep(triangle);
    check.add(change->pieces.size());
    rewriting.change(*change++);
  });
  rewriting.finish();
}

}  // namespace

void join_coincident(Mesh& mesh, Notices& notices, const std::stop_token& stop) {
  const DefaultFloatingPoint mode;
  StopCheck check(stop, "joining faces in the same place");
  const Plates plates = plates_of(mesh, stop);
  const std::vector<BoxPair> pairs = coincident_pairs(plates, stop);
  const Partners partners(plates.all.size(), pairs);
  Joining joining(mesh.materials, plates, check);
  for_each_checked(0, plates.all.size(), check, [&](std::size_t i) {
    if (const auto some = partners.of(i); !some.empty()) joining.join(static_cast<std::uint32_t>(i), some);
  });
  mesh.coincident = joining.joined();
  if (mesh.coincident > 0)
    notices.push_back("faces in the same place as others, taken once: " + std::to_string(mesh.coincident));
  if (joining.emitting() > 0)
    notices.push_back(
        "emitting faces in the same place and facing the same way: they emit once, with the larger radiance: " +
        std::to_string(joining.emitting()));
  if (const std::vector<Change> changes = std::move(joining).take(); !changes.empty())
    rewrite(mesh, plates, changes, check);
}

}  // namespace detp::sim
