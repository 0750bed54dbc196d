#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

// A test must not depend on who starts it, and where. What is set here holds for the commands that tests start, too.

namespace {

/// Some tests say how much work may go on at the same time, or how much memory its threads take: as if there were at most 8 cores.
void use_few_cores() {
  cpu_set_t all{};
  if (sched_getaffinity(0, sizeof all, &all) != 0) return;
  cpu_set_t few{};
  for (std::size_t core = 0; core < CPU_SETSIZE && CPU_COUNT(&few) < 8; ++core)
    if (CPU_ISSET(core, &all)) CPU_SET(core, &few);
  sched_setaffinity(0, sizeof few, &few);
}

/// Tests of memory count pages. A large page makes memory resident that was never touched.
void use_small_pages() { prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0); }

/// Drops what the user's environment would change, the user's calibration and the variables of a surrounding mpirun among them.
void use_plain_environment() {
  setenv("XDG_CACHE_HOME", "/dev/null", 1);
  for (const char* name : {"COLUMNS", "LINES", "NO_COLOR", "DETP_MEMORY_LIMIT"}) unsetenv(name);
  std::vector<std::string> world;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string both = *variable;
    if (both.starts_with("OMPI_") || both.starts_with("PMI")) world.push_back(both.substr(0, both.find('=')));
  }
  for (const std::string& name : world) unsetenv(name.c_str());
}

/// `nohup`, for instance, lets a program start with signals ignored.
void use_default_signals() {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGPIPE}) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

}  // namespace

int main(int argc, char** argv) {
  use_few_cores();
  use_small_pages();
  use_plain_environment();
  use_default_signals();
  return doctest::Context(argc, argv).run();
}
