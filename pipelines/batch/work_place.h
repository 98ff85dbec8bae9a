// SPDX-License-Identifier: Apache-2.0
/// A folder to work in that one process has at a time, and from which finished work is moved into place as a whole.
///
///   ROOT/NAME/lock       who has it: a line of JSON (host, machine, process and its start, a token)
///   ROOT/NAME/TOKEN/     the folder
///
/// The lock is a file created with O_EXCL, which one process alone succeeds at on every file system, NFS too; flock()
/// would be gone with its holder, but holds nothing on cluster file systems mounted without it. A lock is stale, and is
/// taken over, when its holder is gone: a process of this machine (same boot, same process namespace) that is no longer
/// there, or one elsewhere that has not touched its lock for kStaleSeconds, which a living one does every
/// kHeartbeatSeconds. Whoever takes over removes what the holder left, so nothing piles up.
///
/// Two processes can have one place only where a holder stood still for longer than kStaleSeconds and then goes on. Their
/// folders differ, and what has lost its lock is not moved into place: nothing is mixed, work is done twice at most.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace bodyloom {

/// Another process has what is needed, or has taken it over: another try may succeed.
class PlaceTaken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class WorkPlace {
 public:
  static constexpr int kHeartbeatSeconds = 20, kStaleSeconds = 300;

  /// Takes ROOT/NAME, made when it is not there. Throws PlaceTaken, naming the holder, when a living process has it;
  /// std::runtime_error (DiskFullError) for a root that cannot be written.
  WorkPlace(const std::string& root, const std::string& name);
  /// Removes the folder and all that is in it, and gives the place back.
  ~WorkPlace();
  WorkPlace(const WorkPlace&) = delete;
  WorkPlace& operator=(const WorkPlace&) = delete;

  /// Empty at first.
  [[nodiscard]] const std::string& folder() const { return folder_; }

  /// Renames the folder to `target`, on the same file system, in place of a folder there; its files are to be on the disk
  /// already (AtomicPath). Throws PlaceTaken when another process has taken the place meanwhile, and std::runtime_error.
  void MoveFolderTo(const std::string& target);
  /// The same for a file of the folder.
  void MoveFileTo(const std::string& name, const std::string& target);

 private:
  void RequireStillOurs() const;

  std::string place_, lock_, token_, folder_;
  std::jthread heart_;
};

/// Removes the places below `root` whose holders are gone, and `root` when nothing is left in it. A place is otherwise
/// cleared by the next one who takes it: one whose holder was killed after its work had moved into place is taken by
/// nobody again. What cannot be removed stays; nothing is thrown.
void RemoveStalePlaces(const std::string& root);

}  // namespace bodyloom
