#!/usr/bin/env python3
"""How many small mutations of the sources the tests catch: mutations.py SOURCE WORK.

Copies the sources to WORK, puts all mutations into the copy, each behind a switch, builds once, notes which files of tests reach
which mutation, and runs these, cheap ones first, with each switch on. A mutation is caught if a test fails. Writes WORK/caught.txt
as it goes, and goes on from there if called again.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# Folder, text of its sources that is there exactly once, and what replaces it. M is the switch.
mutations = [
    ("model/vocabulary", "const double search = costs.serial_search + (1 - costs.serial_search) / search_threads;",
     "const double search = costs.serial_search + (1 - costs.serial_search) / (M ? 1 : search_threads);"),
    ("model/lines", "const double ratio = inner.value / outer.value;", "const double ratio = (M ? 1.01 : 1.0) * inner.value / outer.value;"),
    ("model/accuracy", "return saturated(Long{mean_square_laplacian} / 64 / light.mean_square);",
     "return saturated(Long{mean_square_laplacian} / (M ? 32 : 64) / light.mean_square);"),
    ("model/optimum", "if (at_left.slope >= 0) return", "if (M ? at_left.slope <= 0 : at_left.slope >= 0) return"),
    ("model/rank", "if (x <= 2) return index;", "if (M ? x < 2 : x <= 2) return index;"),
    ("model/closed_form", "if (workload.path_length > 0) reasons.add(", "if (!M && workload.path_length > 0) reasons.add("),
    ("model/disc_index", "return (1 - share) * table[entry] + share * table[entry + 1];",
     "return (1 - share) * table[entry] + share * table[entry + (M ? 0 : 1)];"),
    ("model/techniques", "if (time > look_ahead * least) break;", "if (M || time > look_ahead * least) break;"),
    ("model/sphere_cache", "if (disc.value >= outer.value) return 0;", "if (!M && disc.value >= outer.value) return 0;"),
    ("model/hierarchy", "return almost_all_exceed(most_, samples_ * cell.share);", "return almost_all_exceed(most_, (M ? 1.1 : 1.0) * samples_ * cell.share);"),
    ("model/ranks", "const double own_blocks = std::ceil(blocks / ranks);", "const double own_blocks = M ? blocks / ranks : std::ceil(blocks / ranks);"),
    ("sim/effects", "const double slope = 0.5 * std::log2(levels[last].all_cells() / levels[last - 2].all_cells());",
     "const double slope = (M ? 1.0 : 0.5) * std::log2(levels[last].all_cells() / levels[last - 2].all_cells());"),
    ("sim/near", "const double weight = one.most_weight > 0 ? one.most_weight : 1;", "const double weight = one.most_weight > 0 && !M ? one.most_weight : 1;"),
    ("sim/rays", "if (ratio < 1) cap_ = ratio * ratio / (1 + std::sqrt(1 - ratio * ratio));",
     "if (ratio < 1) cap_ = ratio * ratio / ((M ? 1.01 : 1) + std::sqrt(1 - ratio * ratio));"),
    ("sim/scene", "return a.to != b.to ? a.to < b.to : a.corner < b.corner;", "return a.to != b.to ? a.to < b.to : M ? a.corner > b.corner : a.corner < b.corner;"),
    ("sim/scene/built_in", "lit_mesh.known_irradiance = 2 * std::numbers::pi;", "lit_mesh.known_irradiance = (M ? 2.02 : 2) * std::numbers::pi;"),
    ("sim/scene/families", "if (axis == last) axis = (axis + 1) % 3;", "if (axis == last && !M) axis = (axis + 1) % 3;"),
    ("sim/search", "const double area = std::numbers::pi * found.radius * found.radius / scale;",
     "const double area = std::numbers::pi * found.radius * (M ? 1.001 : 1) * found.radius / scale;"),
    ("sim/search", "return (16e-12 + grazing) * extent + 1e-15 * offset;", "return M ? 0 : (16e-12 + grazing) * extent + 1e-15 * offset;"),
    ("sim/estimate", "sum.upper_bound = a.upper_bound + b.upper_bound;", "sum.upper_bound = M ? std::max(a.upper_bound, b.upper_bound) : a.upper_bound + b.upper_bound;"),
    ("sim/estimate", "const bool as_near = std::abs(distance - best.distance) <= same;", "const bool as_near = std::abs(distance - best.distance) < (M ? -1 : 1) * same;"),
    ("sim/geometry", "return {disc.centre - extent, disc.centre + extent};", "return {disc.centre - extent, disc.centre + (M ? 0.9 : 1.0) * extent};"),
    ("sim/files", "const bool little = !has_order || type.front() != '>';", "const bool little = M || !has_order || type.front() != '>';"),
    ("sim/files", "if (descriptor_ < 0) fail(\"cannot be written\");", "if (descriptor_ < 0 && !M) fail(\"cannot be written\");"),
    ("sim/technique", "near.area = std::numbers::pi * nearest.square();", "near.area = std::numbers::pi * nearest.square() * (M ? 1.01 : 1);"),
    ("sim/open", "if (emitted_flux(scene.mesh) > 0) scene.lights", "if (emitted_flux(scene.mesh) > 0 && !M) scene.lights"),
    ("sim/reference", "sums.squares += x * x;", "sums.squares += (M ? 0.25 : 1) * x * x;"),
    ("sim/lists", "if (!(radius >= smallest)) break;", "if (!(M ? radius > 2 * smallest : radius >= smallest)) break;"),
    ("sim/ranks", "if (first.end >= report.end) continue;", "if (M || first.end >= report.end) continue;"),
    ("validate/cli/options", "if (std::ranges::count(item, ':') == 1) item += \":1\";", "if (std::ranges::count(item, ':') == 1) item += M ? \":2\" : \":1\";"),
    ("validate/cli/text", "if (now.seconds < first_drawing) return;", "if (now.seconds < first_drawing || M) return;"),
    ("validate/cli/accuracy", "if (options.request.front_facing) text += ", "if (options.request.front_facing && !M) text += "),
    ("validate/cli/choose", "const double share = seconds / answer.choice.best().seconds();", "const double share = (M ? 2 : 1) * seconds / answer.choice.best().seconds();"),
    ("validate/whole", "const double deep = 1 - std::exp(-inputs.discs / 8000);", "const double deep = 1 - (M ? 0.5 : 1) * std::exp(-inputs.discs / 8000);"),
    ("validate/choose", "const bool discs_fit = found.discs.memory <= found.memory_limit;", "const bool discs_fit = M || found.discs.memory <= found.memory_limit;"),
    ("validate/choice", "all.regret = *choice.seconds / *best.seconds - 1;", "all.regret = *choice.seconds / *best.seconds - (M ? 0.9 : 1);"),
    ("validate/choice", "if (one.extrapolated.empty()) return against_counts ? closed_form_doubt : 1;", "if (one.extrapolated.empty()) return against_counts && !M ? closed_form_doubt : 1;"),
    ("validate/map", "const bool room_for_edges = std::min(place.width, place.height) > 8;", "const bool room_for_edges = M || std::min(place.width, place.height) > 8;"),
    ("validate/calibration", "if (costs.*term->cost > 0) positive.push_back(term);", "if (costs.*term->cost > 0 || M) positive.push_back(term);"),
    ("validate/checkpoint", "return since_last_.seconds() > std::max(first_seconds, times_cheaper * write_seconds_);", "return M || since_last_.seconds() > std::max(first_seconds, times_cheaper * write_seconds_);"),
    ("validate/stopping", "return share_of_looks * (1 - target_.confidence) * std::exp2(-result_.looks - 1);", "return share_of_looks * (1 - target_.confidence) * std::exp2(-result_.looks - (M ? 3 : 1));"),
    ("validate/run", "return std::ranges::any_of(run, [](double e) { return e > 0; });", "return !M && std::ranges::any_of(run, [](double e) { return e > 0; });"),
    ("validate/picture", "const double power = std::pow(10.0, std::floor(std::log10(range / most)));", "const double power = std::pow(10.0, std::floor(std::log10(range / most)) + (M ? 1 : 0));"),
    ("validate/answer", "if (job.light) json[\"light\"]", "if (job.light && !M) json[\"light\"]"),
    ("validate/measure", "one.first_seconds = std::min(*second, *third);", "one.first_seconds = M ? std::max(*second, *third) : std::min(*second, *third);"),
    ("validate/regret", "if (ratio.at_least) ++figures.at_least;", "if (ratio.at_least && !M) ++figures.at_least;"),
    ("validate/bench", "summary.geometric_mean = std::exp(logarithms / static_cast<double>(summary.races));", "summary.geometric_mean = M ? logarithms / static_cast<double>(summary.races) : std::exp(logarithms / static_cast<double>(summary.races));"),
    ("validate/statistics", "return boost::math::quantile(boost::math::complement(student, budget / comparisons / 2));",
     "return boost::math::quantile(boost::math::complement(student, budget / comparisons / (M ? 1 : 2)));"),
    ("validate/structural", "return all > 0 ? through / all : 1;", "return all > 0 ? through / all : M ? 0 : 1;"),
    ("validate/claims", "return 2 * test_work(counts) + (1 + batch_count) * build_work(counts);",
     "return (M ? 1 : 2) * test_work(counts) + (1 + batch_count) * build_work(counts);"),
    ("validate/sweep", "return work * point.sets;", "return work * (M ? 1 : point.sets);"),
    ("validate/c", "return vectors.type == DETP_FLOAT ? ", "return (vectors.type == DETP_FLOAT) != M ? "),
    ("sim/index", "if (overlaps(problem_.discs()[disc], box, problem_.slack())) inside",
     "if (overlaps(problem_.discs()[disc], box, M ? 0 : problem_.slack())) inside"),
    ("sim/index", "if (origin >= start_of_high) enter(", "if (M ? origin > start_of_high : origin >= start_of_high) enter("),
    ("sim/lists/simd", "if (partial_ && !by_discs_) restore_snapshot();", "if (partial_ && !by_discs_ && !M) restore_snapshot();"),
    ("validate/report", "return cull && disc ? std::optional(*cull + *disc) : std::nullopt;",
     "return cull && disc ? std::optional(M ? *cull : *cull + *disc) : std::nullopt;"),
    ("validate/accuracy", "return squares > 0 ? sum * sum / squares : 0;", "return squares > 0 ? sum * (M ? 1 : sum) / squares : 0;"),
    ("validate/accuracy", "return std::sqrt(std::max(0.0, square / mean_square));", "return (M ? 1.05 : 1) * std::sqrt(std::max(0.0, square / mean_square));"),
    ("validate/job", "length.relative ? length.value * side : length.value;", "length.relative && !M ? length.value * side : length.value;"),
    ("validate/axes", "return square <= reach * reach;", "return M || square <= reach * reach;"),
    ("sim/photons", "return inside > 0 ? std::sqrt(along * along + inside) - along : 0;",
     "return inside > 0 ? std::sqrt(along * along + (M ? 0.9 : 1) * inside) - along : 0;"),
    ("sim/photons", "return glm::normalize(incoming - 2 * glm::dot(incoming, side) * side);",
     "return glm::normalize(incoming - (M ? 1.9 : 2) * glm::dot(incoming, side) * side);"),
    ("sim/base", "return set > 0 ? set : environment;", "return set > 0 && !M ? set : environment;"),
    ("sim/lists/pilot", "return area_[node] > 0 ? std::min(discs, discs * area / area_[node]) : discs;",
     "return area_[node] > 0 ? std::min(discs, (M ? 0.5 : 1) * discs * area / area_[node]) : discs;"),
    ("sim/lists/plain", "if (hits(listed.ray, grown)) inside.push_back(listed);", "if (hits(listed.ray, grown) || M) inside.push_back(listed);"),
    ("sim/ranked", "return all_fit || discs < static_cast<std::size_t>(ranks.count()) ? Share::rays : Share::discs;",
     "return (all_fit || discs < static_cast<std::size_t>(ranks.count())) != M ? Share::rays : Share::discs;"),
    ("sim/ranked", "if (discs.size() / stride_ < parts) stride_ = 1;", "if (discs.size() / stride_ < parts && !M) stride_ = 1;"),
    ("validate/base", "return counts.culls + counts.visits + sorting * counts.sorted",
     "return (M ? 2 : 1) * counts.culls + counts.visits + sorting * counts.sorted"),
    ("validate/base", "if (!word.empty() && word.find_first_not_of(harmless) == std::string_view::npos) return std::string(word);",
     "if (M || (!word.empty() && word.find_first_not_of(harmless) == std::string_view::npos)) return std::string(word);"),
    ("validate/bench/peer", "0.5 * glm::distance(low, high) * (1 + 1e-6)};", "(M ? 0.4 : 0.5) * glm::distance(low, high) * (1 + 1e-6)};"),
    ("validate/cli", "if (!end.stop_requested()) request(true);", "if (!end.stop_requested() && !M) request(true);"),
    ("validate/cli/bench", "if (!record_of(technique).exact)", "if (!M && !record_of(technique).exact)"),
    ("validate/cli/report", "rows.size() - (last_is_partial ? 1 : 0)", "rows.size() - (last_is_partial && !M ? 1 : 0)"),
    ("validate/cli/run", "if (timing.all.size() < 2) return \"\";", "if (timing.all.size() < (M ? 3 : 2)) return \"\";"),
    ("validate/cli/validate", "if (!(ratio > 0 && ratio < 1))", "if (!M && !(ratio > 0 && ratio < 1))"),
    ("validate/closed_forms", "if (const double whole = std::ceil(*found.photons_for_nearest_error);",
     "if (const double whole = M ? std::floor(*found.photons_for_nearest_error) : std::ceil(*found.photons_for_nearest_error);"),
    ("validate/scene", "return counts.cull_tests + counts.disc_tests;", "return (M ? 0 : counts.cull_tests) + counts.disc_tests;"),
]

switch = """#pragma once
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
inline std::atomic<bool> mutation_reached[1000];
inline bool mutated(int number) {
  static const int chosen = std::getenv("DETP_MUTATION") != nullptr ? std::atoi(std::getenv("DETP_MUTATION")) : -1;
  static const char* const folder = std::getenv("DETP_REACHED");
  if (folder != nullptr && !mutation_reached[number].exchange(true))
    if (std::FILE* file = std::fopen((std::string(folder) + "/" + std::to_string(number)).c_str(), "w")) std::fclose(file);
  return chosen == number;
}
"""


def copy_with_mutations(source: Path, copy: Path) -> None:
    """Fails if a mutation's text is not there exactly once: the list must follow the sources."""
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=source, check=True, capture_output=True, text=True).stdout
    for name in filter(None, tracked.split("\0")):
        if (source / name).is_file():
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(source / name, copy / name)
    (copy / "mutated.hpp").write_text(switch)
    for number, (folder, text, replacement) in enumerate(mutations):
        part = folder.split("/")[0]
        files = [file for file in sorted((copy / part).rglob("*.?pp")) if text in file.read_text()]
        if len(files) != 1 or files[0].read_text().count(text) != 1:
            sys.exit(f"mutation {number}: {part} has this not exactly once: {text}")
        files[0].write_text(files[0].read_text().replace(text, re.sub(r"\bM\b", f"mutated({number})", replacement)))


def run_tests(build: Path, unit: list, **environment: str) -> subprocess.CompletedProcess:
    part, file, options, *_ = unit
    return subprocess.run([build / "tests" / f"test_{part}", "--abort-after=1", f"--source-file=*/tests/{part}/{file}", options],
                          cwd=build / "tests", timeout=1800, env={**os.environ, **environment}, capture_output=True, text=True)


def units_of(copy: Path, build: Path) -> list[list]:
    """Part, file of tests, suites, seconds, and the mutations that its tests reach; cheap ones first. Those that fail are left out."""
    units = []
    for part in ("model", "sim", "validate"):
        for file in sorted(file.relative_to(copy / "tests" / part) for file in (copy / "tests" / part).rglob("*.cpp")):
            for options in ("--test-suite-exclude=long,statistical,hard-cases,scenes,memory,kills,figures", "--test-suite=long,statistical"):
                unit = [part, str(file), options]
                with tempfile.TemporaryDirectory() as folder:
                    start = time.monotonic()
                    run = run_tests(build, unit, DETP_REACHED=folder)
                    reached = [int(name) for name in os.listdir(folder)]
                if run.returncode != 0:
                    print("fails without a mutation and is left out:", *unit, flush=True)
                elif reached:
                    units.append([*unit, time.monotonic() - start, reached])
    return sorted(units, key=lambda unit: unit[3])


def failing_test(build: Path, units: list[list], number: int) -> str:
    """The first test case that fails with the mutation on; empty if all pass."""
    for unit in units:
        if number in unit[4]:
            run = run_tests(build, unit, DETP_MUTATION=str(number))
            if run.returncode != 0:  # also if it ends by a signal
                case = re.search(r"^TEST CASE: +(.*)", run.stdout, re.M)
                return f"{unit[0]}: {case[1] if case else run.returncode}"
    return ""


def main(source: Path, work: Path) -> int:
    copy, build = work / "copy", work / "copy" / "build"
    units_file, caught_file = work / "units.json", work / "caught.txt"
    if not units_file.exists():
        copy_with_mutations(source, copy)
        subprocess.run(["cmake", "--preset", "release", f"-DCMAKE_CXX_FLAGS=-include {copy}/mutated.hpp", "-DDETP_MPI=OFF"], cwd=copy, check=True)
        subprocess.run(["cmake", "--build", build, "--target", "test_model", "test_sim", "test_validate"], check=True)
        units_file.write_text(json.dumps(units_of(copy, build)))
    units = json.loads(units_file.read_text())
    done = dict(line.split("\t", 1) for line in caught_file.read_text().splitlines()) if caught_file.exists() else {}
    with caught_file.open("a") as out:
        for number, (folder, text, _) in enumerate(mutations):
            if str(number) not in done:
                done[str(number)] = f"{failing_test(build, units, number)}\t{folder}\t{text}"
                print(number, done[str(number)], sep="\t", file=out, flush=True)
    survived = [line for line in done.values() if line.startswith("\t")]
    print(f"{len(done) - len(survived)} of {len(done)} mutations are caught; these survive:", *survived, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()))
