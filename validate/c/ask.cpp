#include "detp/validate/cli/command_line.hpp"

#include <cstring>

#include "guard.hpp"

using namespace detp;

extern "C" {

detp_status detp_ask(const char* const* words, size_t count, detp_progress progress, void* user, char** json,
                     detp_error* error) {
  return c::guarded(error, [&] {
    char*& text = c::given(json, "json");
    std::vector<std::string> all;
    if (count > 0) c::given(words, "words");
    for (size_t i = 0; i < count; ++i) all.emplace_back(&c::given(words[i], "a word"));
    const c::Watch watch(progress, user, "working");
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
