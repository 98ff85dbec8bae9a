// SPDX-License-Identifier: Apache-2.0
/// Makes a single-person dataset (single_person_dataset.h) from a motion: the seed determines the person (shape,
/// clothes, colours), the light and the background.
///
/// The cloth is simulated on one thread while earlier frames are rendered on the others, so memory does not grow with
/// the length of the motion. The same bytes for any number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/synthesis/clips/synth_camera.h"
#include "data_tools/synthesis/people/dressed_render.h"
#include "geometry/body/body_model.h"
#include "geometry/cloth/cloth_material.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct MakeSinglePersonDatasetOptions {
  GarmentKind garment = GarmentKind::kSkirt;
  ClothesStyle style = ClothesStyle::kPatterned;
  ClothMaterial material = ClothMaterial::kCotton;  ///< of a loose garment
  uint64_t seed = 1;
  LightStyle light_style = LightStyle::kStudio;
  std::optional<uint64_t> light_seed;  ///< of the light alone, to vary it for one person; absent: `seed`
  int size_px = 256;                   ///< images are square
  double yaw_deg = 0;                  ///< of the camera, about the vertical
  double elevation_deg = 8;
  double shape_sigma = 0.5;     ///< standard deviation of the body's shape components, cut at 2; 0: the mean shape
  int samples = 2;              ///< per pixel along x and y
  int num_threads = 0;          ///< 0: all cores
  std::string motion, command;  ///< information for person.json
  std::function<bool(double)> progress = {};               ///< called with the finished fraction; false: stop
  std::function<void(int, const PersonFrame&)> look = {};  ///< called with every frame, in order
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct MakeSinglePersonDatasetSummary {
  bool finished = false;  ///< false: stopped by `progress`, or failed
  int frames = 0, cuts = 0, cloth_vertices = 0;
  int frames_through = 0;                 ///< frames in which a leg has come through the cloth
  double seconds = 0, cloth_seconds = 0;  ///< wall time; part of it in the cloth (parallel to rendering)
  double largest_stretch = 0;             ///< of the cloth's threads, over all frames
  PersonLight light;
  [[nodiscard]] double frames_per_second() const { return seconds > 0 ? frames / seconds : 0; }
};

/// Shape components of the person of a seed.
Eigen::VectorXd PersonBetas(const BodyModel& body, double sigma, uint64_t seed);

/// A motion in the camera's frame as a track without error: every frame tracked, with exact joints and landmarks.
Track TrueTrack(const BodyModel& body, const Motion& in_camera, const Camera& camera);

/// The true track of a motion (world frame) of that body, and the camera: static, the whole motion in view.
Track TrackInView(const BodyModel& body, const Motion& motion, const MakeSinglePersonDatasetOptions& options,
                  SynthCamera* camera);

/// Writes the dataset. Throws std::invalid_argument when options are out of range or the motion is empty, not finite or
/// not of SMPL's 24 joints, std::runtime_error naming the file that cannot be written.
MakeSinglePersonDatasetSummary MakeSinglePersonDataset(const std::string& folder, const BodyModel& body,
                                                       const Motion& motion,
                                                       const MakeSinglePersonDatasetOptions& options = {});

}  // namespace bodyloom
