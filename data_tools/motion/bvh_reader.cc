// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/motion_readers.h"

#include <algorithm>
#include <cctype>

#include "data_tools/formats/printable.h"
#include "data_tools/motion/text_scanner.h"
#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

constexpr int kMaxBvhJoints = 2000;
constexpr double kSlowestFrame = 10;  ///< seconds

struct Channel {
  int joint = 0;
  int axis = 0;  ///< 0, 1, 2
  bool is_rotation = false;
};

Channel ChannelFromName(TextScanner* scanner, std::string_view name, int joint) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const bool is_rotation = lower.size() == 9 && lower.ends_with("rotation");
  const bool is_position = lower.size() == 9 && lower.ends_with("position");
  const int axis = lower.empty() ? -1 : lower[0] == 'x' ? 0 : lower[0] == 'y' ? 1 : lower[0] == 'z' ? 2 : -1;
  if (axis < 0 || !(is_rotation || is_position)) {
    scanner->Fail("found channel '" + PrintableText(name) + "', expected [XYZ]rotation or [XYZ]position");
  }
  return {joint, axis, is_rotation};
}

/// Words up to the opening brace: names may hold blanks.
std::string NameUpToBrace(TextScanner* scanner) {
  std::string name(scanner->Word("a joint's name"));
  while (scanner->Peek() != "{") {
    name += " " + std::string(scanner->Word("'{'"));
    if (name.size() > 500) scanner->Fail("expected '{' after the joint's name");
  }
  scanner->Expect("{");
  return name;
}

struct Hierarchy {
  SkeletonMotion skeleton;
  std::vector<Eigen::Vector3d> offsets;
  std::vector<Channel> channels;
};

/// Adds a joint with its OFFSET; returns its index.
int AddJoint(TextScanner* scanner, Hierarchy* h, const std::string& name, int parent) {
  if (h->offsets.size() >= kMaxBvhJoints) scanner->Fail("more than " + std::to_string(kMaxBvhJoints) + " joints");
  scanner->Expect("OFFSET");
  Eigen::Vector3d offset;
  for (double& value : offset) value = scanner->Number("an offset");
  h->offsets.push_back(offset);
  h->skeleton.names.push_back(name);
  h->skeleton.parents.push_back(parent);
  return static_cast<int>(h->offsets.size()) - 1;
}

void ReadChannels(TextScanner* scanner, Hierarchy* h, int joint) {
  if (!scanner->Accept("CHANNELS")) return;
  const int count = scanner->Integer("a number of channels", 0, 12);
  for (int c = 0; c < count; ++c) {
    h->channels.push_back(ChannelFromName(scanner, scanner->Word("a channel"), joint));
  }
}

Hierarchy ReadHierarchy(TextScanner* scanner) {
  Hierarchy h;
  scanner->Expect("HIERARCHY");
  scanner->Expect("ROOT");
  const std::string root = NameUpToBrace(scanner);
  std::vector<int> open = {AddJoint(scanner, &h, root, -1)};
  ReadChannels(scanner, &h, 0);
  while (!open.empty()) {
    if (scanner->Accept("}")) {
      open.pop_back();
    } else if (scanner->Accept("End")) {
      scanner->Expect("Site");
      scanner->Expect("{");
      AddJoint(scanner, &h, h.skeleton.names[open.back()] + "_end", open.back());
      scanner->Expect("}");
    } else {
      scanner->Expect("JOINT");
      const std::string name = NameUpToBrace(scanner);
      open.push_back(AddJoint(scanner, &h, name, open.back()));
      ReadChannels(scanner, &h, open.back());
    }
  }
  return h;
}

/// The number of frames that the rest of the text has, whatever its header says, with a warning if they differ. A last
/// frame that is not whole, or whose last number may be cut, is left out.
int FramesPresent(const TextScanner& scanner, int stated, size_t num_channels, const std::string& where,
                  std::vector<std::string>* warnings) {
  const size_t words = scanner.CountWords();
  size_t frames = words / num_channels;
  if (frames > 0 && frames < size_t(stated) && words % num_channels == 0 && scanner.EndsInWord()) --frames;
  if (frames == 0) scanner.Fail("no whole frame of " + std::to_string(num_channels) + " channels");
  if (frames > kMaxRotations) scanner.Fail(std::to_string(frames) + " frames are too many");
  if (frames != size_t(stated) && warnings != nullptr) {
    warnings->push_back(
        Concatenate(where, ": ", frames, " whole frames, the header says ", stated, "; those that are there are read"));
  }
  return static_cast<int>(frames);
}

}  // namespace

SkeletonMotion BvhFromText(const std::string& text, const std::string& where, std::vector<std::string>* warnings) {
  TextScanner scanner(text, where);
  scanner.IgnoreCase();
  Hierarchy h = ReadHierarchy(&scanner);
  SkeletonMotion& motion = h.skeleton;
  const int J = motion.num_joints();
  motion.offsets.resize(J, 3);
  for (int j = 0; j < J; ++j) motion.offsets.row(j) = h.offsets[j].transpose();

  scanner.Expect("MOTION");
  if (!scanner.AcceptPrefix("Frames:")) scanner.Expect("Frames:");
  const int stated = scanner.Integer("a number of frames", 0, static_cast<int>(kMaxRotations));
  scanner.Expect("Frame");
  if (!scanner.AcceptPrefix("Time:")) scanner.Expect("Time:");
  const double frame_time = scanner.Number("a frame time");
  if (!(frame_time > 0 && frame_time < kSlowestFrame)) {
    scanner.Fail("frame time " + std::to_string(frame_time) + " s, expected more than 0 and less than 10");
  }
  const size_t num_channels = h.channels.size();
  if (num_channels == 0) scanner.Fail("no joint has channels");
  const int num_frames = FramesPresent(scanner, stated, num_channels, where, warnings);
  if (size_t(num_frames) * J > kMaxRotations) scanner.Fail(std::to_string(num_frames) + " frames are too many");
  motion.rotations.assign(size_t(num_frames) * J, Eigen::Matrix3d::Identity());
  motion.root_positions = motion.offsets.row(0).replicate(num_frames, 1);
  motion.timestamps = RegularTimestamps(num_frames, frame_time);
  for (int t = 0; t < num_frames; ++t) {
    for (const Channel& channel : h.channels) {
      const double value = scanner.Number("a channel value of frame " + std::to_string(t));
      if (channel.is_rotation) {
        Eigen::Matrix3d& rotation = motion.rotations[size_t(t) * J + channel.joint];
        rotation = rotation * RotationFromAxisAngle(Eigen::Vector3d::Unit(channel.axis) * (value * kDegree));
      } else if (channel.joint == 0) {
        motion.root_positions(t, channel.axis) = value;
      }
    }
  }
  return motion;
}

SkeletonMotion ReadBvh(const std::string& path) { return BvhFromText(ReadTextFile(path), path); }

}  // namespace bodyloom
