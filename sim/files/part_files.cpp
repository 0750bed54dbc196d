#include "part_files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <mutex>
#include <set>

namespace detp::sim {
namespace {

struct PartFiles {
  std::mutex mutex;
  std::set<std::string> names;
  unsigned last = 0;
};

/// Never destroyed, because one thread may end the program at once while another ends it normally.
PartFiles& part_files() {
  static PartFiles& all = *new PartFiles;
  return all;
}

/// A path in the target's folder that no other writer uses, in this process or another.
std::string next_name(PartFiles& all, const std::string& target) {
  const std::string folder = target.substr(0, target.rfind('/') + 1);
  return folder + ".detp-" + std::to_string(::getpid()) + "-" + std::to_string(++all.last) + ".part";
}

/// Calls `create` with new names until a name is not taken, and returns its result. `create` creates a file, or returns
/// -1 with errno set. Sets `name`; if the file was created, adds the name to the part files.
template <class Create>
int create_under_new_name(const std::string& target, std::string& name, const Create& create) {
  PartFiles& all = part_files();
  const std::scoped_lock lock(all.mutex);
  int result = -1;
  do {
    name = next_name(all, target);
    result = create(name.c_str());
  } while (result < 0 && errno == EEXIST);
  if (result >= 0) all.names.insert(name);
  return result;
}

}  // namespace

int create_part_file(const std::string& target, std::string& name) {
  return create_under_new_name(
      target, name, [](const char* path) { return ::open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666); });
}

bool name_part_file(int descriptor, const std::string& target, std::string& name) {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  return create_under_new_name(target, name, [&](const char* path) {
           return ::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, path, AT_SYMLINK_FOLLOW);
         }) >= 0;
}

bool finish_part_file(const std::string& name, const std::string& target) {
  PartFiles& all = part_files();
  const std::scoped_lock lock(all.mutex);
  if (std::rename(name.c_str(), target.c_str()) != 0) return false;
  all.names.erase(name);
  return true;
}

void remove_part_file(const std::string& name) {
  PartFiles& all = part_files();
  const std::scoped_lock lock(all.mutex);
  if (all.names.erase(name) > 0) ::unlink(name.c_str());
}

void remove_all_part_files_for_good() noexcept {
  PartFiles& all = part_files();
  all.mutex.lock();  // never unlocked
  for (const std::string& name : all.names) ::unlink(name.c_str());
}

}  // namespace detp::sim
