#include "detp/validate/cli/ask.hpp"

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "guard.hpp"
#include "progress.hpp"

using namespace detp;

namespace {

/// Calls the caller's progress function ten times a second, so that it can stop the work.
class Asked {
 public:
  explicit Asked(const c::Watch& watch)
      : clock_([&watch](const std::stop_token& end) {
          std::mutex mutex;
          std::condition_variable_any never;
          std::unique_lock lock(mutex);
          while (!never.wait_for(lock, end, std::chrono::milliseconds(100), [] { return false; }) &&
                 !end.stop_requested())
            watch.show("working", 0);
        }) {}

 private:
  std::jthread clock_;
};

}  // namespace

extern "C" {

detp_status detp_ask(const char* const* words, size_t count, detp_progress progress, void* user, char** json,
                     detp_error* error) {
  return c::guarded(error, [&] {
    char*& text = c::given(json, "json");
    std::vector<std::string> all;
    if (count > 0) c::given(words, "words");
    for (size_t i = 0; i < count; ++i) all.emplace_back(&c::given(words[i], "a word"));
    const c::Watch watch(progress, user);
    const Asked asked(watch);
    const std::string answer = cli::ask(all, watch.token()).dump(-1, ' ', false, cli::Json::error_handler_t::replace);
    text = new char[answer.size() + 1];
    std::memcpy(text, answer.c_str(), answer.size() + 1);
  });
}

void detp_text_free(char** text) {
  if (text == nullptr) return;
  delete[] * text;
  *text = nullptr;
}
}
