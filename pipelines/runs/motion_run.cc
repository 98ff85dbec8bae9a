// SPDX-License-Identifier: Apache-2.0
#include "pipelines/runs/motion_run.h"

#include <Eigen/Dense>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/descriptors/dense_history.h"
#include "data_tools/formats/json_reader.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "pipelines/runs/run_config.h"

namespace bodyloom {

namespace {

constexpr const char* kMotionProgram = "bodyloom train motion";
constexpr size_t kMaxShapeComponents = 1000;

Eigen::VectorXd ReadShape(const JsonNode& betas) {
  if (!betas.is_array() || betas.size() > kMaxShapeComponents) {
    betas.Fail(Concatenate("a list of at most ", kMaxShapeComponents, " numbers"));
  }
  const std::vector<double> numbers = betas.Numbers(static_cast<int>(betas.size()));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

nlohmann::ordered_json MotionJson(const SurfaceMotion& motion) {
  nlohmann::ordered_json json = {{"frame", ToString(motion.frame)},
                                 {"velocity", VelocityName(motion)},
                                 {"window_s", motion.velocity.window_s},
                                 {"order", motion.velocity.order},
                                 {"longest_step_s", motion.velocity.longest_step_s}};
  if (motion.frame == SurfaceFrame::kWorld) {
    const Eigen::Matrix3d rows = motion.camera_pose.camera_from_world_rotation.transpose();
    const Eigen::Vector3d& translation = motion.camera_pose.camera_from_world_translation;
    json["camera_from_world_rotation"] = std::vector<double>(rows.data(), rows.data() + 9);
    json["camera_from_world_translation"] = std::vector<double>(translation.begin(), translation.end());
  }
  return json;
}

SurfaceMotion ReadMotion(const JsonNode& json) {
  SurfaceMotion motion;
  std::string why;
  try {
    motion.frame = SurfaceFrameNamed(json.At("frame").Text());
    SetVelocity(json.At("velocity").Text(), &motion);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(json.place() + ": " + error.what());
  }
  motion.velocity.window_s = json.At("window_s").Number();
  motion.velocity.order = json.At("order").Int();
  motion.velocity.longest_step_s = json.At("longest_step_s").Number();
  if (!motion.IsValid(&why)) throw std::runtime_error(json.place() + ": " + why);
  if (motion.frame == SurfaceFrame::kWorld) {
    const std::vector<double> rows = json.At("camera_from_world_rotation").Numbers(9);
    const Eigen::Matrix3d rotation = Eigen::Map<const Eigen::Matrix3d>(rows.data()).transpose();
    if (!IsRotation(rotation, 1e-6)) json.At("camera_from_world_rotation").Fail("a rotation");
    motion.camera_pose.camera_from_world_rotation = rotation;
    const std::vector<double> translation = json.At("camera_from_world_translation").Numbers(3);
    motion.camera_pose.camera_from_world_translation = Eigen::Map<const Eigen::Vector3d>(translation.data());
  }
  return motion;
}

/// Reads the training data from the notes, which other programs' runs may lack.
void ReadTrained(const JsonNode& root, MotionRun* run) {
  if (!root.Has("run")) return;
  const JsonNode notes = root.At("run");
  if (notes.Has("data")) run->data = notes.At("data").Text();
  if (notes.Has("track")) run->track = notes.At("track").Text();
  if (!notes.Has("train")) return;
  const JsonNode ranges = notes.At("train");
  for (size_t i = 0; i < ranges.size(); ++i) {
    const JsonNode range = ranges.At(i);
    run->trained.emplace_back(range.At(0).Int(), range.At(1).Int());
  }
}

}  // namespace

int MotionChannels(MotionDescriptor descriptor, int past) {
  return descriptor == MotionDescriptor::kDense2d ? DenseHistory::kChannelsOfFrame * past : 3 + 3 * past;
}

std::string MotionRunJson(const MotionRun& run) {
  const MotionConfig& c = run.config;
  nlohmann::ordered_json json = {{"program", kMotionProgram},
                                 {"version", BODYLOOM_VERSION},
                                 {"profile", c.profile.name},
                                 {"image_size", c.profile.image_size},
                                 {"uv_size", c.profile.uv_size},
                                 {"features", c.profile.features},
                                 {"texture_size", c.profile.texture_size},
                                 {"texture_features", c.profile.texture_features},
                                 {"encoder_widths", c.profile.encoder_widths},
                                 {"decoder_widths", c.profile.decoder_widths},
                                 {"discriminator_width", c.profile.discriminator_width},
                                 {"perceptual_divisor", c.profile.perceptual_divisor},
                                 {"descriptor", ToText(c.descriptor)},
                                 {"motion_channels", c.motion_channels},
                                 {"num_labels", c.num_labels},
                                 {"shape", c.shape},
                                 {"normals", c.normals},
                                 {"motion", c.motion},
                                 {"surface", c.surface},
                                 {"texture", c.texture},
                                 {"around_body", c.around_body},
                                 {"pixels_per_metre", run.pixels_per_metre},
                                 {"fps", run.fps},
                                 {"past", run.past},
                                 {"reach", run.reach}};
  json["surface_motion"] = MotionJson(run.motion);
  if (run.betas) json["betas"] = std::vector<double>(run.betas->begin(), run.betas->end());
  if (!run.notes.empty()) json["run"] = nlohmann::ordered_json::parse(run.notes);
  return json.dump(2) + "\n";
}

MotionRun ReadMotionRun(const std::string& run_dir) {
  const std::string path = RunConfigPath(run_dir);
  const nlohmann::json json = ReadRunConfig(run_dir, kMotionProgram);
  const JsonNode root(json, path);
  MotionRun run;
  MotionConfig& c = run.config;
  c.profile.name = root.At("profile").Text();
  const std::pair<const char*, int*> numbers[] = {{"image_size", &c.profile.image_size},
                                                  {"uv_size", &c.profile.uv_size},
                                                  {"features", &c.profile.features},
                                                  {"texture_size", &c.profile.texture_size},
                                                  {"texture_features", &c.profile.texture_features},
                                                  {"discriminator_width", &c.profile.discriminator_width},
                                                  {"perceptual_divisor", &c.profile.perceptual_divisor},
                                                  {"motion_channels", &c.motion_channels},
                                                  {"num_labels", &c.num_labels},
                                                  {"past", &run.past},
                                                  {"reach", &run.reach}};
  for (const auto& [key, value] : numbers) *value = root.At(key).Int();
  for (const auto& [key, widths] : {std::pair("encoder_widths", &c.profile.encoder_widths),
                                    std::pair("decoder_widths", &c.profile.decoder_widths)}) {
    const JsonNode list = root.At(key);
    for (size_t i = 0; i < list.size(); ++i) widths->push_back(list.At(i).Int());
  }
  for (const auto& [key, flag] :
       {std::pair("shape", &c.shape), std::pair("normals", &c.normals), std::pair("motion", &c.motion),
        std::pair("surface", &c.surface), std::pair("texture", &c.texture)}) {
    *flag = root.At(key).Flag();
  }
  // Runs from before there was a choice of descriptors have the surface's.
  if (root.Has("descriptor")) {
    try {
      c.descriptor = MotionDescriptorNamed(root.At("descriptor").Text());
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(root.place() + ": " + error.what());
    }
  }
  // Runs from before there was a choice looked at whole windows.
  c.around_body = root.Has("around_body") && root.At("around_body").Flag();
  run.pixels_per_metre = root.At("pixels_per_metre").Number();
  run.fps = root.At("fps").Number();
  if (root.Has("surface_motion")) run.motion = ReadMotion(root.At("surface_motion"));
  // Runs from before motion was carried over without its person's shape do not hold their own.
  if (root.Has("betas")) run.betas = ReadShape(root.At("betas"));
  ReadTrained(root, &run);
  std::string why;
  if (!run.config.IsValid(&why)) throw std::runtime_error(path + ": " + why);
  if (run.reach < (c.around_body ? 1 : 0) || run.reach > run.config.profile.image_size || run.past < 0 ||
      run.past > 10000 || MotionChannels(c.descriptor, run.past) != c.motion_channels || !(run.pixels_per_metre > 0) ||
      !(run.fps > 0)) {
    throw std::runtime_error(path + ": past, reach, pixels_per_metre or fps do not make sense");
  }
  return run;
}

}  // namespace bodyloom
