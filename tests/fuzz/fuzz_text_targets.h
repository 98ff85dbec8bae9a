// SPDX-License-Identifier: Apache-2.0
/// Fuzz targets for text formats: detections, cameras, motions and the body's cage. Each returns true if the input was
/// accepted; accepted data must be consistent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "data_tools/body_making/cage.h"
#include "data_tools/motion/motion_readers.h"
#include "data_tools/observations/colmap_reader.h"
#include "data_tools/observations/detection_readers.h"
#include "data_tools/observations/load_camera_path.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/pose2sim_toml.h"
#include "data_tools/observations/rig_io.h"
#include "tests/fuzz/fuzz_accepts.h"

namespace bodyloom::fuzz {

inline void CheckPeople(const PeopleSequence& people) {
  if (people.timestamps.size() != people.frames.size()) throw std::logic_error("frames without a time");
  for (const auto& frame : people.frames) {
    for (const DetectedPerson& person : frame) {
      if (person.points.size() != people.convention.names.size())
        throw std::logic_error("a person of another number of joints");
    }
  }
}

/// Every reader must accept or reject the file, regardless of its format.
inline bool AcceptsDetections(const std::string& bytes) {
  nlohmann::json json;
  if (!Accepts([&] { json = ParseJsonLines(bytes, "fuzz.json", {.nan_is_null = true}); })) return false;
  const JsonNode document(json, "fuzz.json");
  bool taken = false;
  if (IsOpenPoseJson(document)) taken |= Accepts([&] { CheckPeople(OpenPoseFromJson(document, 30)); });
  if (IsMmposeJson(document)) taken |= Accepts([&] { CheckPeople(MmposeFromJson(document, 30)); });
  if (IsCocoJson(document)) taken |= Accepts([&] { CheckPeople(CocoFromJson(document, 30)); });
  if (IsUltralyticsJson(document)) taken |= Accepts([&] { CheckPeople(UltralyticsFromJson(document, 30)); });
  if (IsVitPoseJson(document)) taken |= Accepts([&] { CheckPeople(VitPoseFromJson(document, 30)); });
  if (IsBlazePoseJson(document)) taken |= Accepts([&] { CheckPeople(BlazePoseFromJson(document, 30)); });
  return taken;
}

inline bool AcceptsDeepLabCut(const std::string& bytes) {
  return Accepts([&] { CheckPeople(DeepLabCutFromCsv(bytes, "fuzz.csv", 30)); });
}

/// Reads the input as JSON and as Pose2Sim's TOML.
inline bool AcceptsCameras(const std::string& bytes) {
  bool taken = Accepts([&] {
    for (const NamedCamera& camera : CamerasFromText(bytes, "fuzz.json")) {
      if (!(camera.camera.fx > 0) || !(camera.camera.fy > 0)) throw std::logic_error("a camera without a focal length");
    }
  });
  taken |= Accepts([&] {
    for (const nlohmann::json& camera : CamerasOfPose2SimToml(bytes, "fuzz.toml")) {
      if (!camera.contains("name")) throw std::logic_error("a camera without a name");
    }
  });
  return taken;
}

inline bool AcceptsRig(const std::string& bytes) {
  return Accepts([&] {
    for (const RigCamera& camera : RigFromText(bytes, "fuzz.json")) {
      if (!camera.camera_from_rig.camera_from_world_rotation.allFinite()) {
        throw std::logic_error("a camera without a rotation");
      }
      if (camera.offset_sigma_s < 0 || !(camera.rate > -1)) throw std::logic_error("a clock that does not run");
    }
  });
}

/// Reads the input as this project's JSON and as each of COLMAP's files.
inline bool AcceptsCameraPath(const std::string& bytes) {
  bool taken = Accepts([&] {
    const RecordedCameraPath path = CameraPathFromText(bytes, "fuzz.json");
    if (path.poses.empty() || path.frames.size() + path.seconds.size() != path.poses.size()) {
      throw std::logic_error("poses without a frame or a time");
    }
  });
  const auto check_images = [](const std::vector<ColmapImage>& images) {
    for (const ColmapImage& image : images) {
      if (!image.pose.camera_from_world_rotation.allFinite()) throw std::logic_error("a camera without a rotation");
    }
  };
  const auto check_cameras = [](const std::map<uint32_t, ColmapCamera>& cameras) {
    for (const auto& [id, camera] : cameras) {
      if (camera.is_pinhole && !(camera.camera.fx > 0)) throw std::logic_error("a camera without a focal length");
    }
  };
  taken |= Accepts([&] { check_images(ColmapImagesFromText(bytes, "fuzz.txt")); });
  taken |= Accepts([&] { check_images(ColmapImagesFromBytes(bytes, "fuzz.bin")); });
  taken |= Accepts([&] { check_cameras(ColmapCamerasFromText(bytes, "fuzz.txt")); });
  taken |= Accepts([&] { check_cameras(ColmapCamerasFromBytes(bytes, "fuzz.bin")); });
  return taken;
}

inline void CheckSkeleton(const SkeletonMotion& motion) {
  if (motion.rotations.size() != static_cast<size_t>(motion.num_frames()) * motion.num_joints()) {
    throw std::logic_error("rotations of another number");
  }
  for (int j = 0; j < motion.num_joints(); ++j) {
    if (motion.parents[j] >= j) throw std::logic_error("a joint before its parent");
  }
  if (!motion.offsets.allFinite() || !motion.root_positions.allFinite()) throw std::logic_error("not finite");
}

inline bool AcceptsBvh(const std::string& bytes) {
  return Accepts([&] { CheckSkeleton(BvhFromText(bytes, "fuzz.bvh")); });
}

/// Skeleton and motion in one input, separated at the first form feed.
inline bool AcceptsAsfAmc(const std::string& bytes) {
  const size_t apart = std::min(bytes.find('\f'), bytes.size());
  const std::string motion = apart < bytes.size() ? bytes.substr(apart + 1) : "";
  return Accepts([&] { CheckSkeleton(AsfAmcFromText(bytes.substr(0, apart), "fuzz.asf", motion, "fuzz.amc", 120)); });
}

inline bool AcceptsDeepMimic(const std::string& bytes) {
  return Accepts([&] {
    const nlohmann::json json = ParseJson(bytes, "fuzz.txt");
    CheckSkeleton(DeepMimicFromJson(JsonNode(json, "fuzz.txt")));
  });
}

inline bool AcceptsCage(const std::string& bytes) {
  return Accepts([&] {
    const Cage cage = ParseCage(bytes, "fuzz.txt");
    for (const Quad& quad : cage.quads) {
      for (const int v : quad) {
        if (v < 0 || v >= cage.vertices.rows()) throw std::logic_error("a corner outside the cage");
      }
    }
  });
}

}  // namespace bodyloom::fuzz
