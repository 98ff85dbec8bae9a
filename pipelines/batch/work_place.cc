// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/batch/work_place.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/printable.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr size_t kMostLockBytes = 4096;
constexpr int kTriesToClaim = 5;

/// Contents of a small file, of /proc too; empty where it cannot be read.
std::string SmallFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostLockBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(file.gcount()));
  return text;
}

std::string HostName() {
  char name[256] = "";
  ::gethostname(name, sizeof name - 1);
  return name;
}

/// The same for two processes that see each other in /proc, and for no others.
std::string MachineName() {
  std::string boot = SmallFile("/proc/sys/kernel/random/boot_id");
  if (!boot.empty() && boot.back() == '\n') boot.pop_back();
  std::error_code error;
  const std::string processes = fs::read_symlink("/proc/self/ns/pid", error).string();
  return boot.empty() || processes.empty() ? "" : boot + " " + processes;
}

/// When the process began, in ticks since the boot; empty when there is no such process or it has ended.
std::string StartOf(const std::string& process) {
  const std::string stat = SmallFile("/proc/" + process + "/stat");
  // "pid (name) state ppid …": the name may hold anything, the start is field 22.
  size_t at = stat.rfind(')');
  if (at == std::string::npos || at + 2 >= stat.size() || stat[at + 2] == 'Z' || stat[at + 2] == 'X') return "";
  for (int field = 2; field < 22; ++field) {
    at = stat.find(' ', at + 1);
    if (at == std::string::npos) return "";
  }
  return stat.substr(at + 1, stat.find(' ', at + 1) - at - 1);
}

std::string NewToken() {
  std::random_device random;
  char text[40];
  std::snprintf(text, sizeof text, "%ld-%08x%08x", static_cast<long>(::getpid()), random(), random());
  return text;
}

struct LockHolder {
  std::string host, machine, start, token;
  long process = 0;
};

std::string LockText(const std::string& token) {
  return json({{"host", HostName()},
               {"machine", MachineName()},
               {"process", static_cast<long>(::getpid())},
               {"start", StartOf("self")},
               {"token", token},
               {"time", static_cast<long>(::time(nullptr))}})
             .dump(-1, ' ', false, json::error_handler_t::replace) +
         "\n";
}

/// Nothing for a lock that was not written to its end.
std::optional<LockHolder> ReadLock(const std::string& path) {
  const json lock = json::parse(SmallFile(path), nullptr, false);
  if (!lock.is_object()) return std::nullopt;
  const auto text = [&](const char* key) {
    const auto found = lock.find(key);
    return found != lock.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  LockHolder holder{text("host"), text("machine"), text("start"), text("token"), 0};
  if (const auto found = lock.find("process"); found != lock.end() && found->is_number_integer()) {
    holder.process = found->get<long>();
  }
  return holder;
}

bool IsOld(const std::string& path) {
  struct stat info {};
  return ::stat(path.c_str(), &info) == 0 && ::time(nullptr) - info.st_mtime > WorkPlace::kStaleSeconds;
}

bool IsStale(const std::string& path, const std::optional<LockHolder>& holder) {
  if (holder && holder->process > 0 && !holder->machine.empty() && holder->machine == MachineName()) {
    const std::string start = StartOf(std::to_string(holder->process));
    return start.empty() || start != holder->start;
  }
  return IsOld(path);
}

[[noreturn]] void FailPlace(const std::string& path, const std::string& action, int reason) {
  const std::string message = path + ": cannot " + action + ": " + std::strerror(reason);
  if (reason == ENOSPC || reason == EDQUOT) throw DiskFullError(message);
  throw std::runtime_error(message);
}

/// A new file with that text; what goes wrong is said of `named`. A text that finds no room leaves no file. False when the
/// file is there, or its folder gone.
bool WriteNew(const std::string& path, const std::string& text, const std::string& named) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0 && (errno == EEXIST || errno == ENOENT)) return false;
  if (fd < 0) FailPlace(named, "create", errno);
  const ssize_t written = ::write(fd, text.data(), text.size());
  const int reason = written < 0 ? errno : ENOSPC;
  const bool closed = ::close(fd) == 0;
  if (written == static_cast<ssize_t>(text.size()) && closed) return true;
  ::unlink(path.c_str());
  FailPlace(named, "write", reason);
}

/// The same, whole from its first moment: a process that is killed on the way leaves no file without its name in it, of
/// which nobody knows whose it is. File systems without hard links go without.
bool CreateAlone(const std::string& path, const std::string& text) {
  const std::string whole = path + "." + NewToken();
  if (!WriteNew(whole, text, path)) return false;
  const bool linked = ::link(whole.c_str(), path.c_str()) == 0;
  const int reason = errno;
  ::unlink(whole.c_str());
  if (linked) return true;
  return reason != EEXIST && reason != ENOENT && WriteNew(path, text, path);
}

/// Takes a stale lock away, unless somebody else is about to, or has: of several that find it stale, one goes on.
void RemoveStale(const std::string& lock, const std::string& token) {
  const std::string breaking = lock + ".stale";
  if (!CreateAlone(breaking, LockText(NewToken()))) {
    if (IsStale(breaking, ReadLock(breaking))) ::unlink(breaking.c_str());
    return;
  }
  const std::optional<LockHolder> now = ReadLock(lock);
  // A lock without a token may be one that is just being written.
  if ((now ? now->token : "") == token && (!token.empty() || IsOld(lock))) ::unlink(lock.c_str());
  ::unlink(breaking.c_str());
}

void SyncFolder(const fs::path& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;  // not every file system lets a folder be opened
  ::fsync(fd);
  ::close(fd);
}

/// Touches the lock until it is told to stop.
void KeepTouching(const std::stop_token& stop, const std::string& lock) {
  std::mutex mutex;
  std::condition_variable_any wait;
  std::unique_lock<std::mutex> hold(mutex);
  while (!wait.wait_for(hold, stop, std::chrono::seconds(WorkPlace::kHeartbeatSeconds), [] { return false; }) &&
         !stop.stop_requested()) {
    ::utimensat(AT_FDCWD, lock.c_str(), nullptr, 0);
  }
}

}  // namespace

WorkPlace::WorkPlace(const std::string& root, const std::string& name)
    : place_((fs::path(root) / name).string()), lock_(place_ + "/lock"), token_(NewToken()) {
  folder_ = place_ + "/" + token_;
  bool ours = false;
  for (int i = 0; i < kTriesToClaim && !ours; ++i) {
    std::error_code error;
    fs::create_directories(place_, error);
    if (error == std::errc::no_such_file_or_directory) continue;  // the root went with the last place in it
    if (error) FailPlace(place_, "make the folder", error.value());
    ours = CreateAlone(lock_, LockText(token_));
    if (ours) break;
    const std::optional<LockHolder> holder = ReadLock(lock_);
    if (!fs::exists(lock_, error)) continue;  // given back meanwhile
    if (!IsStale(lock_, holder)) {
      throw PlaceTaken(holder && holder->process > 0 ? "process " + std::to_string(holder->process) + " on " +
                                                           PrintableText(holder->host) + " is at it"
                                                     : "another process is at it");
    }
    RemoveStale(lock_, holder ? holder->token : "");
  }
  if (!ours) throw PlaceTaken("other processes are about to do it");
  try {
    for (const fs::directory_entry& left : fs::directory_iterator(place_)) {
      if (left.path().filename() != "lock") fs::remove_all(left.path());
    }
    fs::create_directory(folder_);
    heart_ = std::jthread(KeepTouching, lock_);
  } catch (const fs::filesystem_error& error) {
    ::unlink(lock_.c_str());
    FailPlace(place_, "be used", error.code().value());
  }
}

WorkPlace::~WorkPlace() {
  heart_ = {};
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
  const std::optional<LockHolder> holder = ReadLock(lock_);
  if (holder && holder->token == token_) ::unlink(lock_.c_str());
  // Both fail, rightly, where another process has it, or another place, by now.
  ::rmdir(place_.c_str());
  ::rmdir(fs::path(place_).parent_path().c_str());
}

void WorkPlace::RequireStillOurs() const {
  const std::optional<LockHolder> holder = ReadLock(lock_);
  if (!holder || holder->token != token_) throw PlaceTaken("another process has taken it over");
}

void WorkPlace::MoveFolderTo(const std::string& target) {
  RequireStillOurs();
  SyncFolder(folder_);
  std::error_code error;
  fs::create_directories(fs::path(target).parent_path(), error);
  const std::string old = place_ + "/old-" + token_;
  if (::rename(target.c_str(), old.c_str()) != 0 && errno != ENOENT) FailPlace(target, "move away", errno);
  if (::rename(folder_.c_str(), target.c_str()) != 0) {
    const int reason = errno;
    ::rename(old.c_str(), target.c_str());
    FailPlace(target, "move the finished folder into place", reason);
  }
  SyncFolder(fs::path(target).parent_path());
  fs::remove_all(old, error);
}

void WorkPlace::MoveFileTo(const std::string& name, const std::string& target) {
  RequireStillOurs();
  std::error_code error;
  fs::create_directories(fs::path(target).parent_path(), error);
  if (::rename((folder_ + "/" + name).c_str(), target.c_str()) != 0) {
    FailPlace(target, "move the finished file into place", errno);
  }
  SyncFolder(fs::path(target).parent_path());
}

void RemoveStalePlaces(const std::string& root) {
  std::error_code error;
  std::vector<fs::path> places;
  for (fs::directory_iterator at(root, error), end; !error && at != end; at.increment(error)) {
    places.push_back(at->path());
  }
  for (const fs::path& place : places) {
    const std::string lock = (place / "lock").string();
    if (fs::exists(lock, error)) {
      if (!IsStale(lock, ReadLock(lock))) continue;
    } else if (::rmdir(place.c_str()) == 0 || errno != ENOTEMPTY) {
      continue;  // its holder was killed between its lock and its folder
    }
    // Without a lock, and not empty: whoever took it over was killed between the lock of before and its own.
    try {
      const WorkPlace taken(root, place.filename().string());
    } catch (const std::runtime_error&) {  // somebody has it by now, or the root cannot be written
    }
  }
  ::rmdir(root.c_str());
}

}  // namespace bodyloom
