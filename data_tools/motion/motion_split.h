// SPDX-License-Identifier: Apache-2.0
/// The written-down division of a motion library: what each clip shows and whether it is kept for testing.
///
/// A text file, one line a clip: `name  class  train|test`, separated by blanks; `#` hides the rest of a line. The name
/// is the clip's path without the extensions of its format (.gz, .bvh, .amc, …), or its last parts: `05_02` names
/// `cmu_bvh/05_02.bvh.gz` and `05_02.amc` alike, `cmu_bvh/05_02` only the first. The longest name that fits counts.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bodyloom {

struct MotionSplitEntry {
  std::string motion_class;
  bool test = false;
};

class MotionSplit {
 public:
  /// The entry for a clip by its path ('/' separators); nullptr when it is not named. `name`, when given, receives the
  /// name by which it was found.
  [[nodiscard]] const MotionSplitEntry* Find(const std::string& path, std::string* name = nullptr) const;
  [[nodiscard]] const std::map<std::string, MotionSplitEntry>& entries() const { return entries_; }

 private:
  friend MotionSplit MotionSplitFromText(const std::string& text, const std::string& where);
  std::map<std::string, MotionSplitEntry> entries_;
};

/// What a clip may show: walk run jump dance kick punch sport climb sit floor acrobatic other.
const std::vector<std::string>& MotionClasses();

/// Throws std::runtime_error "where: line N: …" for a line with other than three words, an unknown class, a third word
/// that is neither train nor test, and a name that came before.
MotionSplit MotionSplitFromText(const std::string& text, const std::string& where);
MotionSplit ReadMotionSplit(const std::string& path);

/// The project's own (assets/lifter/motion_split.txt, embedded).
const MotionSplit& BuiltinMotionSplit();

/// A path without the extensions of motion files: "a/05_02.bvh.gz" → "a/05_02".
std::string WithoutMotionExtension(const std::string& path);

}  // namespace bodyloom
