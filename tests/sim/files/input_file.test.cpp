#include "detp/sim/files/input_file.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <stop_token>
#include <thread>

#include "detp/sim/base/stopped.hpp"
#include "detp/sim/files/disc_file.hpp"
#include "detp/sim/files/mesh_file.hpp"
#include "detp/sim/files/ray_file.hpp"
#include "detp/sim/files/table.hpp"
#include "support/packed.hpp"
#include "support/scratch_file.hpp"

using namespace detp;
using namespace detp::sim;
using support::packed;
using support::ScratchFolder;

namespace {

/// A named pipe.
std::string pipe_in(const ScratchFolder& folder, const std::string& name) {
  const std::string path = folder.path(name);
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  return path;
}

/// Writes the text to the pipe repeatedly, until the reader closes it or `most` bytes are written.
std::jthread endless_writer(const std::string& path, const std::string& front, const std::string& text,
                            std::size_t most) {
  return std::jthread([=] {
    ::signal(SIGPIPE, SIG_IGN);
    const int descriptor = ::open(path.c_str(), O_WRONLY);
    std::string block;
    while (block.size() < (1 << 16)) block += text;
    bool open = ::write(descriptor, front.data(), front.size()) >= 0;
    for (std::size_t written = 0; open && written < most; written += block.size())
      open = ::write(descriptor, block.data(), block.size()) >= 0;
    ::close(descriptor);
  });
}

constexpr std::size_t gigabyte = 1'000'000'000;

std::string mesh_refusal(const std::string& path) {
  return support::file_error_of([&] {
    Notices notices;
    (void)read_mesh(path, notices);
  });
}

}  // namespace

TEST_SUITE("known answer") {
  TEST_CASE("a file is read in pieces of any size, and the number of bytes left is known") {
    const ScratchFolder folder;
    std::string content;
    for (int i = 0; i < 100'000; ++i) content += std::to_string(i) + ",";
    InputFile file(folder.file("f", content));
    std::string read;
    for (std::size_t step = 1; file.fetch(step); step = step * 3 % 100'003) {
      CHECK(file.rest() == content.size() - read.size());
      read += file.buffered().substr(0, step);
      file.skip(step);
    }
    read += file.buffered();
    CHECK(read == content);
    CHECK(read_file(folder.path("f"), content.size()) == content);
    CHECK(support::file_error_of([&] { (void)read_file(folder.path("f"), content.size() - 1); }).find("is larger") !=
          std::string::npos);
  }

  TEST_CASE("a pipe that is written byte by byte gives the same rays as a file") {
    const ScratchFolder folder;
    const std::string path = pipe_in(folder, "rays.csv");
    const std::jthread writer([&] {
      const int descriptor = ::open(path.c_str(), O_WRONLY);
      for (const char* part : {"ox,oy,oz,dx,dy,dz\n0,0,0,", "0,0,1", "\n1,2,3,4,0,0\r", "\n"}) {
        CHECK(::write(descriptor, part, std::string_view(part).size()) > 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
      ::close(descriptor);
    });
    const std::vector<Ray> rays = read_rays(path).paths.rays;
    REQUIRE(rays.size() == 2);
    CHECK(rays[1].origin == glm::dvec3{1, 2, 3});
  }
}

TEST_SUITE("bad input") {
  TEST_CASE("endless input is refused at its first bad line") {
    const ScratchFolder folder;
    struct Endless {
      std::string name, front, text, reason;
    };
    for (const auto& [bound_name, front, text, reason] :
         {Endless{"a.obj", "", "y\n", ":101: most lines"}, Endless{"b.obj", "", "v 1 x 3\n", ":1: \"x\""},
          Endless{"c.obj", "v ", "9", ":1: the line is longer than 16777216 bytes"},
          Endless{"d.obj", "v 1 2 3\n", "f 1 1 \\\n", ":2: the joined lines are longer"},
          Endless{"e.ply", "", "y\n", ":1: is not a PLY file"},
          Endless{"f.ply", "ply\n", "comment c\n", "the header is longer"},
          Endless{"g.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                  "z\nend_header\n",
                  "1", "vertex 1 of 3 (line 8): its \"x\""},
          Endless{"h.csv", "", "1", "the line is longer"},
          Endless{"i.csv", "x,y,z,nx,ny,nz\n", "0,0,0,0,0,0\n", ":2: the normal is zero"}}) {
      const auto& name = bound_name;
      CAPTURE(name);
      const std::string path = pipe_in(folder, name);
      const std::jthread writer = endless_writer(path, front, text, gigabyte);
      const std::string message =
          name.ends_with(".csv") ? support::file_error_of([&] { (void)read_discs(path, 1.0); }) : mesh_refusal(path);
      CHECK_MESSAGE(message.find(reason) != std::string::npos, message);
    }
  }

  TEST_CASE("devices and sparse files without lines are refused at once") {
    const ScratchFolder folder;
    for (const char* name : {"zero.obj", "zero.ply"}) {
      std::filesystem::create_symlink("/dev/zero", folder.path(name));
      CHECK(mesh_refusal(folder.path(name)).find(":1: contains a NUL byte") != std::string::npos);
    }
    CHECK(support::file_error_of([] { (void)read_rays("/dev/zero"); }).find(":1: contains a NUL byte") !=
          std::string::npos);
    for (const char* name : {"sparse.ply", "sparse.obj", "sparse.csv"}) {
      const std::string path = folder.file(name, "");
      std::filesystem::resize_file(path, 5 * gigabyte);
      CHECK(support::file_error_of([&] { (void)read_discs(path, 1.0); }).find(":1: contains a NUL byte") !=
            std::string::npos);
    }
  }

  TEST_CASE("rows that would exceed the memory are refused before it is allocated") {
    const ScratchFolder folder;
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 100000000000\nproperty char x\nproperty char y\n"
        "property char z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string path = folder.file("sparse.ply", header);
    std::filesystem::resize_file(path, 301 * gigabyte);
    Notices notices;
    CHECK_THROWS_WITH_AS((void)read_mesh(path, notices), doctest::Contains("memory"), std::length_error);
  }
}

TEST_SUITE("identity") {
  TEST_CASE("a stop request ends the wait for a pipe that has no writer or delivers nothing") {
    const ScratchFolder folder;
    for (const char* name : {"a.csv", "b.ply", "c.obj"})
      for (const bool opened : {false, true}) {
        CAPTURE(name);
        const std::string path = pipe_in(folder, std::string(opened ? "opened-" : "") + name);
        const int writer = opened ? ::open(path.c_str(), O_RDWR) : -1;
        std::stop_source stop;
        const std::jthread stopper([&] {
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
          stop.request_stop();
        });
        Notices notices;
        if (path.ends_with(".csv"))
          CHECK_THROWS_WITH_AS((void)read_rays(path, stop.get_token()), doctest::Contains("stopped while reading"),
                               Stopped);
        else
          CHECK_THROWS_AS((void)read_mesh(path, notices, stop.get_token()), Stopped);
        if (opened) ::close(writer);
      }
  }

  TEST_CASE("a stop request ends reading between pieces; the message says after how many bytes") {
    const ScratchFolder folder;
    std::stop_source stop;
    std::string text = "x,y,z,nx,ny,nz\n";
    for (int i = 0; i < 100'000; ++i) text += "0,0,0,0,0,1\n";
    const std::string path = folder.file("discs.csv", text);
    stop.request_stop();
    CHECK_THROWS_WITH_AS((void)read_discs(path, 1.0, stop.get_token()),
                         (path + " after 0 bytes").insert(0, "stopped while reading ").c_str(), Stopped);
    std::stop_source later;
    const std::string pipe = pipe_in(folder, "endless.csv");
    const std::jthread writer = endless_writer(pipe, "x,y,z,nx,ny,nz\n", "0,0,0,0,0,1\n", 4'000'000);
    std::uint64_t rows = 0;
    const auto stop_after_1000 = [&](const TableRow&) {
      if (++rows == 1000) later.request_stop();
    };
    CHECK_THROWS_AS(
        read_table(pipe,
                   std::vector<TableColumn>{
                       {"x", {}, {}}, {"y", {}, {}}, {"z", {}, {}}, {"nx", {}, {}}, {"ny", {}, {}}, {"nz", {}, {}}},
                   stop_after_1000, later.get_token()),
        Stopped);
    CHECK(rows < 1000 + (1 << 17) / 12 + 1);  // at most the rows that had been read before
  }
}

TEST_SUITE("compressed files") {
  TEST_CASE("what gzip has packed is read as it was, in one member or several") {
    const ScratchFolder folder;
    std::string text = "x,y,z,nx,ny,nz,radius\n";
    for (int i = 0; i < 100'000; ++i) text += std::to_string(i % 977) + ",0,0,0,0,1,1\n";
    const auto plain = read_discs(folder.file("a.csv", text), {});
    for (const std::string& content : {packed(text), packed(text.substr(0, 999)) + packed(text.substr(999)), text}) {
      const auto found = read_discs(folder.file("a.csv.GZ", content), {});
      REQUIRE(found.size() == plain.size());
      for (std::size_t i = 0; i < plain.size(); ++i) REQUIRE(found[i].centre == plain[i].centre);
    }
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float nx\nproperty float ny\nproperty float nz\nend_header\n1 2 3 0 0 1\n";
    CHECK(read_discs(folder.file("a.ply.gz", packed(ply)), 1).front().centre == glm::dvec3(1, 2, 3));
    Notices notices;
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    CHECK(read_mesh(folder.file("a.obj.gz", packed(mesh)), notices).triangles.size() == 1);
  }

  TEST_CASE("damaged and cut off ones are refused") {
    const ScratchFolder folder;
    std::string text = "x,y,z,nx,ny,nz,radius\n";
    for (int i = 0; i < 1000; ++i) text += std::to_string(i * i) + ",0,0,0,0,1,1\n";
    const std::string good = packed(text);
    const auto error = [&](const std::string& content, const char* name = "a.csv.gz") {
      return support::file_error_of([&] { (void)read_discs(folder.file(name, content), {}); });
    };
    CHECK(error(good.substr(0, good.size() / 2)).find("ends in the middle of its compressed data") !=
          std::string::npos);
    std::string damaged = good;
    for (std::size_t i = good.size() / 2; i < good.size() / 2 + 20; ++i) damaged[i] = static_cast<char>(~damaged[i]);
    CHECK(error(damaged).find("has damaged compressed data") != std::string::npos);
    CHECK(error(good, "a.npy.gz").find("unpack it first") != std::string::npos);
    CHECK(error(good + "more").find("has damaged compressed data") != std::string::npos);
  }
}
