// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_readers.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "data_tools/formats/printable.h"
#include "data_tools/motion/text_scanner.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxBones = 2000;

/// A degree of freedom: translation or rotation along an axis.
struct Freedom {
  bool is_rotation = true;
  int axis = 0;
};

struct Bone {
  std::string name;
  std::string parent;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();  ///< direction · length, world axes, file units
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  std::vector<Freedom> freedoms;
};

struct Asf {
  std::vector<Bone> bones;  ///< bones[0] is the root; parents come before children
  double radians_per_unit = M_PI / 180;
};

std::string Lower(std::string_view word) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return lower;
}

/// "rx" → rotation about x; "TZ" → translation along z.
bool ParseFreedom(std::string_view word, Freedom* freedom) {
  const std::string lower = Lower(word);
  if (lower.size() != 2 || (lower[0] != 'r' && lower[0] != 't') || lower[1] < 'x' || lower[1] > 'z') return false;
  *freedom = {lower[0] == 'r', lower[1] - 'x'};
  return true;
}

/// Angles applied in the order of `order` about fixed axes: "XYZ" → Rz·Ry·Rx.
Eigen::Matrix3d EulerFrame(TextScanner* scanner, const Eigen::Vector3d& radians, std::string_view order) {
  if (order.size() != 3) scanner->Fail("found axis order '" + PrintableText(order) + "', expected XYZ");
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const int axis = std::toupper(static_cast<unsigned char>(order[i])) - 'X';
    if (axis < 0 || axis > 2) scanner->Fail("found axis order '" + PrintableText(order) + "', expected XYZ");
    R = RotationFromAxisAngle(Eigen::Vector3d::Unit(axis) * radians[i]) * R;
  }
  return R;
}

Eigen::Vector3d ReadVector(TextScanner* scanner, const std::string& what) {
  Eigen::Vector3d v;
  for (double& value : v) value = scanner->Number(what);
  return v;
}

bool IsSection(std::string_view word) { return !word.empty() && word[0] == ':'; }

void ReadRoot(TextScanner* scanner, Asf* asf) {
  Bone& root = asf->bones[0];
  Eigen::Vector3d orientation = Eigen::Vector3d::Zero();
  std::string order = "XYZ";
  while (!scanner->AtEnd() && !IsSection(scanner->Peek())) {
    const std::string key = Lower(scanner->Word("a key of :root"));
    if (key == "order") {
      Freedom freedom;
      while (ParseFreedom(scanner->Peek(), &freedom)) {
        scanner->Word("");
        root.freedoms.push_back(freedom);
      }
    } else if (key == "axis") {
      order = scanner->Word("an axis order");
    } else if (key == "position") {
      ReadVector(scanner, "a position");  // where the root stands at rest: overwritten by every frame
    } else if (key == "orientation") {
      orientation = ReadVector(scanner, "an orientation") * asf->radians_per_unit;
    } else {
      scanner->Fail("found '" + PrintableText(key) + "', expected order, axis, position or orientation");
    }
  }
  root.frame = EulerFrame(scanner, orientation, order);
}

void ReadBone(TextScanner* scanner, Asf* asf) {
  Bone bone;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0;
  while (!scanner->Accept("end")) {
    const std::string key = Lower(scanner->Word("'end' of the bone"));
    if (key == "name") {
      bone.name = scanner->Word("a bone's name");
    } else if (key == "direction") {
      direction = ReadVector(scanner, "a direction");
    } else if (key == "length") {
      length = scanner->Number("a length");
    } else if (key == "axis") {
      const Eigen::Vector3d angles = ReadVector(scanner, "an axis angle") * asf->radians_per_unit;
      bone.frame = EulerFrame(scanner, angles, scanner->Word("an axis order"));
    } else if (key == "dof") {
      Freedom freedom;
      while (ParseFreedom(scanner->Peek(), &freedom)) {
        scanner->Word("");
        bone.freedoms.push_back(freedom);
      }
    }  // id, limits, bodymass, … do not matter here
  }
  if (bone.name.empty()) scanner->Fail("a bone without a name");
  if (asf->bones.size() >= kMaxBones) scanner->Fail("more than " + std::to_string(kMaxBones) + " bones");
  bone.vector = direction.norm() > 0 ? Eigen::Vector3d(direction.normalized() * length) : Eigen::Vector3d::Zero();
  asf->bones.push_back(bone);
}

/// Assigns every bone's parent and sorts parents before children.
void SetParents(TextScanner* scanner, Asf* asf, const std::map<std::string, std::string>& parent_of) {
  std::map<std::string, size_t> index;
  for (size_t b = 0; b < asf->bones.size(); ++b) index[asf->bones[b].name] = b;
  std::vector<Bone> ordered = {asf->bones[0]};
  std::vector<bool> placed(asf->bones.size(), false);
  placed[0] = true;
  for (bool progress = true; progress;) {  // repeats until no bone finds its parent: at most the depth of the tree
    progress = false;
    for (size_t b = 1; b < asf->bones.size(); ++b) {
      if (placed[b]) continue;
      const auto found = parent_of.find(asf->bones[b].name);
      if (found == parent_of.end()) continue;
      const auto parent = index.find(found->second);
      if (parent == index.end())
        scanner->Fail("hierarchy names an unknown bone '" + PrintableText(found->second) + "'");
      if (!placed[parent->second]) continue;
      asf->bones[b].parent = found->second;
      ordered.push_back(asf->bones[b]);
      placed[b] = progress = true;
    }
  }
  for (size_t b = 0; b < asf->bones.size(); ++b) {
    if (!placed[b]) scanner->Fail("bone '" + PrintableText(asf->bones[b].name) + "' does not hang on the root");
  }
  asf->bones = std::move(ordered);
}

/// The lines "parent child child …" of the section ":hierarchy" as child → parent. The only section where lines matter,
/// so it is taken from the text itself and not from the scanner's words.
std::map<std::string, std::string> HierarchyLines(const std::string& text) {
  std::map<std::string, std::string> parent_of;
  bool is_inside = false;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    TextScanner words(std::string_view(text).substr(begin, end - begin), "", '#');
    begin = end + 1;
    const std::string_view first = words.Peek();
    if (IsSection(first)) is_inside = first == ":hierarchy";
    if (!is_inside || first.empty() || IsSection(first) || first == "begin" || first == "end") continue;
    const std::string parent(words.Word("a bone"));
    while (!words.AtEnd()) parent_of.emplace(std::string(words.Word("a bone")), parent);
  }
  return parent_of;
}

Asf ReadAsf(const std::string& text, const std::string& where) {
  TextScanner scanner(text, where, '#');
  Asf asf;
  asf.bones.emplace_back();
  asf.bones[0].name = "root";
  while (!scanner.AtEnd()) {
    const std::string section = Lower(scanner.Word("a section"));
    if (section == ":root") {
      ReadRoot(&scanner, &asf);
    } else if (section == ":bonedata") {
      while (scanner.Accept("begin")) ReadBone(&scanner, &asf);
    } else if (section == ":units") {
      while (!scanner.AtEnd() && !IsSection(scanner.Peek())) {
        if (Lower(scanner.Word("a unit")) == "angle") {
          const std::string unit = Lower(scanner.Word("deg or rad"));
          if (unit != "deg" && unit != "rad")
            scanner.Fail("found angle unit '" + PrintableText(unit) + "', expected deg or rad");
          asf.radians_per_unit = unit == "deg" ? M_PI / 180 : 1;
        }
      }
    }  // version, name, documentation, skin: skipped word by word
  }
  if (asf.bones.size() < 2) scanner.Fail("no bones, expected a section :bonedata");
  const std::map<std::string, std::string> parent_of = HierarchyLines(text);
  if (parent_of.empty()) scanner.Fail("no section :hierarchy");
  SetParents(&scanner, &asf, parent_of);
  return asf;
}

SkeletonMotion Skeleton(const Asf& asf) {
  SkeletonMotion motion;
  std::map<std::string, int> index;
  std::vector<Eigen::Vector3d> offsets;
  std::vector<bool> has_child(asf.bones.size(), false);
  for (size_t b = 0; b < asf.bones.size(); ++b) {
    const Bone& bone = asf.bones[b];
    const int parent = b == 0 ? -1 : index.at(bone.parent);
    index[bone.name] = static_cast<int>(b);
    if (parent >= 0) has_child[parent] = true;
    motion.names.push_back(bone.name);
    motion.parents.push_back(parent);
    // A joint sits at the near end of its bone, which is the far end of the parent's.
    offsets.push_back(parent > 0 ? asf.bones[parent].vector : Eigen::Vector3d::Zero());
  }
  for (size_t b = 1; b < asf.bones.size(); ++b) {
    if (has_child[b]) continue;
    motion.names.push_back(asf.bones[b].name + "_end");
    motion.parents.push_back(static_cast<int>(b));
    offsets.push_back(asf.bones[b].vector);
  }
  motion.offsets.resize(motion.num_joints(), 3);
  for (int j = 0; j < motion.num_joints(); ++j) motion.offsets.row(j) = offsets[j].transpose();
  return motion;
}

/// Skips the header of an AMC: comments and ":KEYWORD" lines; returns radians per unit.
double ReadAmcHeader(TextScanner* scanner) {
  double radians_per_unit = M_PI / 180;
  while (IsSection(scanner->Peek())) {
    if (Lower(scanner->Word("")) == ":radians") radians_per_unit = 1;
  }
  return radians_per_unit;
}

}  // namespace

SkeletonMotion AsfAmcFromText(const std::string& asf_text, const std::string& asf_where, const std::string& amc,
                              const std::string& amc_where, double fps) {
  BODYLOOM_CHECK(fps > 0 && fps < 1e5, "frame rate ", fps, " must be positive");
  const Asf asf = ReadAsf(asf_text, asf_where);
  SkeletonMotion motion = Skeleton(asf);
  const int J = motion.num_joints();
  std::map<std::string, int, std::less<>> index;
  for (size_t b = 0; b < asf.bones.size(); ++b) index[asf.bones[b].name] = static_cast<int>(b);

  TextScanner scanner(amc, amc_where, '#');
  const double unit = ReadAmcHeader(&scanner);
  std::vector<Eigen::Vector3d> positions;
  std::vector<bool> seen, seen_first;
  while (!scanner.AtEnd()) {
    scanner.Integer("a frame number", 0, 1'000'000'000);
    const size_t t = positions.size();
    if ((t + 1) * J > kMaxRotations) scanner.Fail("more than " + std::to_string(t) + " frames are too many");
    motion.rotations.resize((t + 1) * J, Eigen::Matrix3d::Identity());
    positions.emplace_back(Eigen::Vector3d::Zero());
    seen.assign(asf.bones.size(), false);
    while (!scanner.AtEnd() && (std::isdigit(static_cast<unsigned char>(scanner.Peek()[0])) == 0)) {
      const std::string_view name = scanner.Word("a bone");
      const auto found = index.find(name);
      if (found == index.end()) {
        scanner.Fail("bone '" + PrintableText(name) + "' is not in the skeleton " + asf_where);
      }
      const Bone& bone = asf.bones[found->second];
      if (seen[found->second])
        scanner.Fail("bone '" + PrintableText(bone.name) + "' occurs twice in frame " + std::to_string(t + 1));
      seen[found->second] = true;
      Eigen::Matrix3d M = Eigen::Matrix3d::Identity();
      for (const Freedom& freedom : bone.freedoms) {
        const double value =
            scanner.Number("a value of '" + PrintableText(bone.name) + "' in frame " + std::to_string(t + 1));
        if (freedom.is_rotation) {
          M = RotationFromAxisAngle(Eigen::Vector3d::Unit(freedom.axis) * (value * unit)) * M;
        } else if (found->second == 0) {
          positions[t][freedom.axis] = value;
        }
      }
      motion.rotations[t * J + found->second] = bone.frame * M * bone.frame.transpose();
    }
    if (t == 0) seen_first = seen;
    if (!seen[0]) scanner.Fail("frame " + std::to_string(t + 1) + " lacks the root");
    for (size_t b = 0; b < asf.bones.size(); ++b) {
      if (seen[b] == seen_first[b]) continue;
      scanner.Fail("bone '" + PrintableText(asf.bones[b].name) + "' is in only one of frames 1 and " +
                   std::to_string(t + 1));
    }
  }
  if (positions.empty()) scanner.Fail("no frames");
  motion.root_positions.resize(static_cast<Eigen::Index>(positions.size()), 3);
  for (size_t t = 0; t < positions.size(); ++t) motion.root_positions.row(t) = positions[t].transpose();
  motion.timestamps = RegularTimestamps(static_cast<int>(positions.size()), 1 / fps);
  return motion;
}

SkeletonMotion ReadAsfAmc(const std::string& amc_path, const std::string& asf_path, double fps) {
  std::string skeleton = asf_path;
  if (skeleton.empty()) {
    const fs::path path(amc_path);
    const std::string name = path.filename().string();
    const fs::path base = path.parent_path() / name.substr(0, name.find('_'));
    std::error_code ignored;
    for (const char* extension : {".asf", ".asf.gz"}) {
      if (skeleton.empty() && fs::exists(base.string() + extension, ignored)) skeleton = base.string() + extension;
    }
    if (skeleton.empty()) {
      throw std::runtime_error(amc_path + ": no skeleton beside it, expected " + base.string() + ".asf or .asf.gz");
    }
  }
  return AsfAmcFromText(ReadTextFile(skeleton), skeleton, ReadTextFile(amc_path), amc_path, fps);
}

}  // namespace bodyloom
