#include "detp/validate/checkpoint/checkpoint_file.hpp"

#include <doctest/doctest.h>

#include <string>

#include "support/scratch_file.hpp"

using namespace detp;
using nlohmann::json;

namespace {

const json some_state{{"sums", {5.008125, 0.25, 1e-9}}, {"photons", 12345}, {"note", "a \"word\""}};

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a state is read back, and one of which any digit was altered is refused and stays as it is") {
    const support::ScratchFolder folder;
    const std::string path = folder.path("state.json");
    validate::CheckpointFile file(path, "work", {{"seed", 10}});
    CHECK_FALSE(file.read());
    file.write(some_state);
    CHECK(file.read() == some_state);
    const std::string good = support::content_of(path);
    int altered = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
      if (good[i] < '0' || good[i] > '9') continue;
      std::string bad = good;
      bad[i] = good[i] == '9' ? '8' : static_cast<char>(good[i] + 1);
      folder.file("state.json", bad);
      CAPTURE(bad);
      CHECK_THROWS_AS(static_cast<void>(file.read()), sim::FileError);
      CHECK(support::content_of(path) == bad);
      ++altered;
    }
    CHECK(altered > 20);
    folder.file("state.json", json::parse(good).dump(2));  // the same in another layout
    CHECK(file.read() == some_state);
  }

  TEST_CASE("files that work beginning anew may replace: none, an empty one and checkpoints") {
    const support::ScratchFolder folder;
    validate::CheckpointFile(folder.path("state.json"), "work", {{"seed", 1}}).write(some_state);
    validate::require_replaceable(folder.path("state.json"));
    validate::require_replaceable(folder.path("none.json"));
    validate::require_replaceable(folder.file("empty.json", ""));
    validate::require_replaceable("/dev/null");
    const std::string good = support::content_of(folder.path("state.json"));
    for (const std::string& other :
         {std::string("x"), std::string("{}"), good.substr(1), good.substr(0, 20), " " + good})
      CHECK_THROWS_AS(validate::require_replaceable(folder.file("other.json", other)), sim::FileError);
  }
}
