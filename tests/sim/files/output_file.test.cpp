#include "detp/sim/files/output_file.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "detp/sim/files/output_place.hpp"
#include "detp/sim/files/part_files.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using support::content_of;
using support::ScratchFolder;

namespace {

void write_whole(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

std::string write_error(const std::string& path, const std::string& text) {
  return support::file_error_of([&] { write_whole(path, text); });
}

/// Whether the file system has files without a name, and /proc can name them; says so if not.
bool has_nameless_files(const ScratchFolder& folder) {
  const int descriptor = ::open(folder.path(".").c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (descriptor >= 0) ::close(descriptor);
  const bool has = descriptor >= 0 && std::filesystem::exists("/proc/self/fd");
  if (!has) MESSAGE("skipped: no files without a name in ", folder.path("."));
  return has;
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a file appears on commit, with all its content, and not before") {
    const ScratchFolder folder;
    const std::string large(1'000'000, 'x');
    OutputFile file(folder.path("out"));
    file.write("first ");
    file.write(large);
    CHECK(!std::filesystem::exists(folder.path("out")));
    if (has_nameless_files(folder)) CHECK(folder.entries() == 0);  // not even a part of it is there
    file.commit();
    CHECK(content_of(folder.path("out")) == "first " + large);
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("if nameless files are not supported, the writer removes its part file") {
    const ScratchFolder folder;
    for (const bool committed : {false, true}) {
      OutputFile file(folder.path("out"), {}, OutputFile::Temporary::named);
      file.write(std::string(200'000, 'x'));
      CHECK(folder.entries() == 1);
      CHECK(!std::filesystem::exists(folder.path("out")));
      if (committed) file.commit();
    }
    CHECK(content_of(folder.path("out")) == std::string(200'000, 'x'));
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("a program that is killed or must end at once leaves no part file") {
    const ScratchFolder folder;
    const std::string existing = folder.file("existing", "old");
    const auto end_of = [&](OutputFile::Temporary temporary, const auto& end) {
      const pid_t child = ::fork();
      if (child == 0) {
        OutputFile file(folder.path("out"), {}, temporary);
        OutputFile over(existing, {}, temporary);
        for (OutputFile* each : {&file, &over}) each->write(std::string(200'000, 'x'));
        end();
        ::_exit(0);
      }
      int status = 0;
      REQUIRE(::waitpid(child, &status, 0) == child);
    };
    if (has_nameless_files(folder)) end_of(OutputFile::Temporary::unnamed, [] { ::raise(SIGKILL); });
    CHECK(folder.entries() == 1);
    end_of(OutputFile::Temporary::named, [] { remove_all_part_files_for_good(); });
    CHECK(folder.entries() == 1);
    CHECK(content_of(existing) == "old");
  }

  TEST_CASE("an existing file stays as it was until commit, and keeps its permissions") {
    const ScratchFolder folder;
    const std::string path = folder.file("out", "old");
    REQUIRE(::chmod(path.c_str(), 0640) == 0);
    {
      OutputFile abandoned(path);
      abandoned.write(std::string(200'000, 'x'));
      CHECK(content_of(path) == "old");
    }
    CHECK(content_of(path) == "old");
    CHECK(folder.entries() == 1);
    write_whole(path, "new");
    CHECK(content_of(path) == "new");
    struct stat status {};
    REQUIRE(::stat(path.c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0640);
  }

  TEST_CASE("a link is followed, also to a file that does not exist yet") {
    const ScratchFolder folder;
    std::filesystem::create_symlink("target", folder.path("link"));
    for (const char* text : {"first", "second"}) {
      write_whole(folder.path("link"), text);
      CHECK(std::filesystem::is_symlink(folder.path("link")));
      CHECK(content_of(folder.path("target")) == text);
    }
  }

  TEST_CASE("an open descriptor is written from its current position") {
    const ScratchFolder folder;
    const int descriptor = ::open(folder.path("log").c_str(), O_WRONLY | O_CREAT, 0666);
    REQUIRE(::write(descriptor, "before ", 7) == 7);
    write_whole("/dev/fd/" + std::to_string(descriptor), "between");
    REQUIRE(::write(descriptor, " after", 6) == 6);
    ::close(descriptor);
    CHECK(content_of(folder.path("log")) == "before between after");
  }

  TEST_CASE("a descriptor that is not open is reported") {
    CHECK(write_error("/dev/fd/987654", "a") == "/dev/fd/987654: cannot be written: Bad file descriptor");
  }

  TEST_CASE("a pipe is written directly, and require_writable does not open it") {
    const ScratchFolder folder;
    const std::string path = folder.path("pipe");
    REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
    require_writable(path);
    std::string read;
    std::jthread reader([&] { read = content_of(path); });
    write_whole(path, "through");
    reader.join();
    CHECK(read == "through");
    CHECK(std::filesystem::is_fifo(path));
  }

  TEST_CASE("all names of one place are recognised") {
    const ScratchFolder folder;
    const std::string file = folder.file("file", "");
    std::filesystem::create_directory(folder.path("inner"));
    std::filesystem::create_symlink("file", folder.path("link"));
    std::filesystem::create_symlink("new", folder.path("dangling"));
    std::filesystem::create_directory_symlink("inner", folder.path("inner-link"));
    std::filesystem::create_hard_link(file, folder.path("hard"));
    for (const char* other : {"file", "./file", "link", "inner/../file", "hard", "inner-link/../link"})
      CHECK(same_place(file, folder.path(other)));
    for (const char* other : {"new", "inner/../new", "dangling"})
      CHECK(same_place(folder.path("new"), folder.path(other)));
    CHECK(same_place(folder.path("inner/x"), folder.path("inner-link/x")));
    CHECK(!same_place(file, folder.path("new")));
    CHECK(!same_place(folder.path("new"), folder.path("newer")));
    CHECK(!same_place(folder.path("new"), folder.path("inner/new")));
    CHECK(!same_place("/dev/null", "/dev/null"));
    const int descriptor = ::open(file.c_str(), O_WRONLY);
    CHECK(same_place(file, "/dev/fd/" + std::to_string(descriptor)));
    ::close(descriptor);
    if (!std::filesystem::is_character_file("/dev/stdout")) CHECK(same_place("/dev/stdout", "/dev/fd/1"));
  }

  TEST_CASE("a device is written directly") {
    write_whole("/dev/null", "anything");
    CHECK(std::filesystem::is_character_file("/dev/null"));
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("a full device is reported with the system's reason, at once or on commit") {
    if (!std::filesystem::exists("/dev/full")) {
      MESSAGE("skipped: there is no /dev/full");
      return;
    }
    for (const std::size_t size : {std::size_t{1}, std::size_t{1'000'000}})
      CHECK(write_error("/dev/full", std::string(size, 'x')) ==
            "/dev/full: cannot be written: No space left on device");
  }

  TEST_CASE("a missing folder, a file in place of a folder, and a folder in place of a file are reported") {
    const ScratchFolder folder;
    const std::string plain = folder.file("plain", "");
    CHECK(write_error(folder.path("missing/out"), "x").find("cannot be written: No such file") != std::string::npos);
    CHECK(write_error(plain + "/out", "x").find("cannot be written: Not a directory") != std::string::npos);
    std::filesystem::create_directory(folder.path("inner"));
    CHECK(write_error(folder.path("inner"), "x").find("cannot be written: Is a directory") != std::string::npos);
    CHECK(write_error("", "x").find("No such file") != std::string::npos);
    CHECK(write_error(folder.path(std::string(300, 'n')), "x").find("File name too long") != std::string::npos);
    std::filesystem::create_symlink("b", folder.path("a"));
    std::filesystem::create_symlink("a", folder.path("b"));
    CHECK(write_error(folder.path("a"), "x").find("Too many levels of symbolic links") != std::string::npos);
    CHECK(std::filesystem::is_symlink(folder.path("a")));
    std::filesystem::remove(folder.path("a"));
    std::filesystem::remove(folder.path("b"));
    CHECK(folder.entries() == 2);
  }

  TEST_CASE("a write-protected file is not written, and nothing is left behind") {
    const ScratchFolder folder;
    const std::string path = folder.file("read-only", "old");
    REQUIRE(::chmod(path.c_str(), 0440) == 0);
    const bool root = ::geteuid() == 0;  // may write everywhere, so the file is written as somebody else
    constexpr uid_t somebody = 65534;
    if (root) {
      for (const std::string& one : {folder.path("."), path}) REQUIRE(::chown(one.c_str(), somebody, 0) == 0);
      REQUIRE(::seteuid(somebody) == 0);
    }
    const std::string error = write_error(path, "new");
    if (root) REQUIRE(::seteuid(0) == 0);
    CHECK_MESSAGE(error.find("cannot be written: Permission denied") != std::string::npos, error);
    CHECK(content_of(path) == "old");
    CHECK(folder.entries() == 1);
  }
}
