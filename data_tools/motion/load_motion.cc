// SPDX-License-Identifier: Apache-2.0
#include "data_tools/motion/load_motion.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/object_npy.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/motion/amass.h"
#include "data_tools/motion/motion_readers.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/text_scanner.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kAcclaimFps = 120;
constexpr const char* kExpectedMotion =
    "expected AMASS .npz (poses, trans), AIST++ motions .pkl, .bvh, .amc with its .asf, DeepMimic JSON or AMP .npy";

bool HasExtension(const std::string& path, const std::string& extension) {
  return path.ends_with(extension) || path.ends_with(extension + ".gz");
}

/// Skeletons and their motions; nullopt-like: false when the text is none of them.
bool SkeletonFromText(const std::string& text, const std::string& path, const LoadMotionOptions& options,
                      std::vector<std::string>* warnings, SkeletonMotion* skeleton) {
  TextScanner scanner(text, path);
  const std::string first(scanner.Peek().substr(0, 64));
  scanner.IgnoreCase();
  if (scanner.Accept("HIERARCHY")) {
    *skeleton = BvhFromText(text, path, warnings);
    return true;
  }
  if (HasExtension(path, ".asf")) {
    throw std::runtime_error(path + ": a skeleton without motion, expected the .amc that goes with it");
  }
  if (HasExtension(path, ".amc") || first.starts_with("#!OML") || first == ":FULLY-SPECIFIED") {
    *skeleton = ReadAsfAmc(path, options.skeleton_path, options.fps > 0 ? options.fps : kAcclaimFps);
    return true;
  }
  if (!first.empty() && (first[0] == '{' || first[0] == '[')) {
    const nlohmann::json json = ParseJson(text, path);
    const JsonNode document(json, path);
    if (!IsDeepMimicJson(document)) throw std::runtime_error(path + ": JSON without 'Frames'; " + kExpectedMotion);
    *skeleton = DeepMimicFromJson(document);
    return true;
  }
  return false;
}

Motion ReadBytes(const std::string& bytes, const std::string& path, const LoadMotionOptions& options,
                 RetargetSummary* summary, std::vector<std::string>* warnings) {
  if (bytes.empty()) throw std::runtime_error(path + ": the file is empty; " + kExpectedMotion);
  if (bytes.compare(0, 4, "PK\x03\x04") == 0) {
    const NpzArrays arrays = ReadNpzBytes(bytes, path);
    if (!IsAmass(arrays))
      throw std::runtime_error(path + ": an .npz without 'trans' and 'poses' (or 'root_orient' and 'pose_body'); " +
                               kExpectedMotion);
    return AmassFromNpz(arrays, path, warnings);
  }
  if (IsObjectNpy(bytes)) return RetargetToSmpl(AmpFromNpyBytes(bytes, path), path, summary);
  if (bytes[0] == '\x80' || bytes.compare(0, 2, "(d") == 0) {
    const PicklePtr file = ReadPickle(bytes, path);
    if (!IsAistMotion(*file)) throw std::runtime_error(path + ": a pickle without 'smpl_poses'; " + kExpectedMotion);
    return AistMotionFromPickle(*file, path, options.fps > 0 ? options.fps : kAistFps);
  }
  SkeletonMotion skeleton;
  if (SkeletonFromText(bytes, path, options, warnings, &skeleton)) return RetargetToSmpl(skeleton, path, summary);
  throw std::runtime_error(path + ": unknown kind of file; " + kExpectedMotion);
}

}  // namespace

Motion MotionFromBytes(const std::string& bytes, const std::string& where, const LoadMotionOptions& options,
                       RetargetSummary* summary, std::vector<std::string>* warnings) {
  BODYLOOM_CHECK(options.fps >= 0 && options.resample_fps >= 0, "frame rates ", options.fps, " and ",
                 options.resample_fps, " must not be negative");
  const Motion motion = ReadBytes(bytes, where, options, summary, warnings);
  return options.resample_fps > 0 ? ResampleMotion(motion, options.resample_fps) : motion;
}

Motion LoadMotion(const std::string& path, const LoadMotionOptions& options, RetargetSummary* summary,
                  std::vector<std::string>* warnings) {
  return MotionFromBytes(ReadTextFile(path), path, options, summary, warnings);
}

}  // namespace bodyloom
