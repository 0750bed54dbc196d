#include <doctest/doctest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>

#include "support/command.hpp"

namespace detp::support {
namespace {

/// Runs detp in a shell. `before` stands before the command, `after` after its arguments.
struct Shell {
  ScratchFolder folder;

  /// The exit code as the shell reports it; for an abort 134.
  [[nodiscard]] int run(const std::string& before, const std::string& arguments, const std::string& after) const {
    const std::string line = before + " " + DETP_COMMAND + " " + arguments + " 2>" + folder.path("err") + " " + after;
    const int status = std::system(("(" + line + "; echo $? >" + folder.path("code") + ") </dev/null").c_str());
    CAPTURE(line);
    REQUIRE(WIFEXITED(status));
    return std::atoi(content_of(folder.path("code")).c_str());
  }
  [[nodiscard]] std::string err() const { return content_of(folder.path("err")); }
};

const std::string csv = "run @uniform --samples 100000 --rays 1000 --technique sphere-tree --per-disc ";

}  // namespace

TEST_SUITE("bad input") {
  TEST_CASE("a limit of file size ends with code 2, a message, and no file") {
    const Shell shell;
    const std::string path = shell.folder.path("out");
    CHECK(shell.run("ulimit -f 8;", csv + path, ">/dev/null") == 2);
    CHECK(shell.err() == "detp: " + path + ": cannot be written: File too large\n");
    CHECK(shell.folder.entries() == 2);  // err and code
  }

  TEST_CASE("a reader that closes the pipe ends with code 2 and a message") {
    const Shell shell;
    CHECK(shell.run("", csv + "/dev/stdout", "| true; true") == 0);  // the shell reports the exit code of `true`
    CHECK(shell.err().find("Broken pipe") != std::string::npos);
    const std::string line = std::string("{ ") + DETP_COMMAND + " " + csv + "/dev/stdout 2>" +
                             shell.folder.path("err") + "; echo $? >" + shell.folder.path("own") + "; } | true";
    CHECK(std::system(line.c_str()) == 0);
    CHECK(content_of(shell.folder.path("own")) == "2\n");
    CHECK(shell.err() == "detp: standard output: cannot be written: Broken pipe\n");
  }

  TEST_CASE("closed and full output ends with code 2; closed input and messages do no harm") {
    const Shell shell;
    const std::string model = "model --samples 100 --disc-radius 0.1 --scene-side 2";
    CHECK(shell.run("", model, ">&-") == 2);
    CHECK(shell.err().find("standard output: cannot be written: Bad file descriptor") != std::string::npos);
    for (const std::string arguments : {model.c_str(), "--help", "model --help", "--version"}) {
      CAPTURE(arguments);
      CHECK(shell.run("", arguments, ">/dev/full") == 2);
      CHECK(shell.err().find("standard output: cannot be written: ") != std::string::npos);
    }
    CHECK(shell.run("", "model --samples x", ">/dev/null 2>&-") == 2);
    CHECK(shell.run("", "model --samples x", ">/dev/null 2>/dev/full") == 2);
    const std::string output = shell.folder.path("out");
    CHECK(shell.run("", model + " --output " + output, ">&- 2>&- <&-") == 0);
    CHECK(content_of(output).starts_with("technique"));
  }
}

TEST_SUITE("end to end") {
  TEST_CASE("a file name that is not UTF-8, or has control characters, is shown escaped, and JSON stays JSON") {
    const ScratchFolder folder;
    const std::string name = folder.path("\xff\x1b[2J.obj");
    std::ofstream(name) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const Finished json = detp(Arguments{"scene", name} + words("--rays 10 --format json"));
    CHECK(json.code == 0);
    CHECK(json.json().at("triangles") == 1);
    const Finished text = detp(Arguments{"scene", name} + words("--rays 10"));
    CHECK(text.code == 0);
    CHECK(text.out.find("\\xff\\x1b[2J.obj") != std::string::npos);
    CHECK(text.out.find('\x1b') == std::string::npos);
    const Finished bench = detp(Arguments{"bench", name} + words("--rays 10"));
    CHECK(bench.code == 0);
    CHECK(bench.out.find("\\xff\\x1b[2J") != std::string::npos);
    CHECK(bench.out.find('\x1b') == std::string::npos);
    const Finished missing = detp(Arguments{"scene", name + ".obj", "--rays", "10"});
    CHECK(missing.code == 2);
    CHECK(missing.err.find("\\xff\\x1b[2J.obj.obj: cannot be opened") != std::string::npos);
  }

  TEST_CASE("a time limit or a signal ends the wait for a pipe without a writer") {
    const ScratchFolder folder;
    const std::string pipe = folder.path("pipe.csv");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    const Arguments run = Arguments{"run", "--discs", pipe} + words("--disc-radius 1 --rays 10");
    const Finished limited = detp(run + words("--time-limit 0.1"));
    CHECK(limited.code == 3);
    CHECK(limited.err.find("stopped while reading") != std::string::npos);
    const std::string checkpoint = folder.path("pipe");
    REQUIRE(::mkfifo(checkpoint.c_str(), 0600) == 0);
    const Finished resumed = detp("validate --effort thorough --resume --time-limit 0.1 --checkpoint " + checkpoint);
    CHECK(resumed.code == 3);
    Process process(run);
    process.wait_until_it_listens();
    process.send(SIGINT);
    const Finished interrupted = process.finish();
    CHECK(interrupted.code == 3);
    CHECK(interrupted.err.find("stopped while reading") != std::string::npos);
  }

  TEST_CASE("results can be written through links, pipes and devices") {
    const ScratchFolder folder;
    std::filesystem::create_symlink("target", folder.path("link"));
    const std::string model = "model --samples 100 --disc-radius 0.1 --scene-side 2 --output ";
    CHECK(detp(model + folder.path("link")).code == 0);
    CHECK(std::filesystem::is_symlink(folder.path("link")));
    const std::string expected = content_of(folder.path("target"));
    CHECK(expected.starts_with("technique"));
    CHECK(detp(model + "/dev/null").code == 0);
    CHECK(detp(model + "/dev/stdout").out == expected);
    const std::string pipe = folder.path("pipe");
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    Process process(words("run @uniform --samples 10 --rays 10 --per-disc " + pipe));
    CHECK(content_of(pipe).starts_with("disc,x,y,z,nx,ny,nz,radius,vertex,hits,irradiance\n0,"));
    CHECK(process.finish().code == 0);
  }
}

}  // namespace detp::support
