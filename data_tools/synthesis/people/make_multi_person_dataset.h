// SPDX-License-Identifier: Apache-2.0
/// Makes a dataset of many synthetic people, each in several actions seen by several cameras (multi_person_dataset.h),
/// similar to 3DPeople (Pumarola et al., ICCV 2019): the seed determines bodies, clothes, colours and light.
///
/// A clip has `frames` frames, `every` apart, of a random part of a motion. The cloth is simulated once for all views
/// of an action, through all frames in between. The camera follows the person across the floor at constant height, so
/// that the person fills the image everywhere. Views are spread evenly around the person from a random first one. The
/// same bytes for any number of threads; clips are made in parallel.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "data_tools/synthesis/people/dressed_render.h"
#include "data_tools/synthesis/people/outfit.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct MakeMultiPersonDatasetOptions {
  int people = 20, actions = 3, views = 2;
  int frames = 6, every = 6;  ///< of a clip; frames of the motion between them
  double test_share = 0.2;    ///< of the people: the last ones, at least one when there are two or more
  int size_px = 256;
  double elevation_low_deg = 0, elevation_high_deg = 20;
  double shape_sigma = 1;
  ClothesStyle style = ClothesStyle::kPatterned;
  LightStyle light_style = LightStyle::kStudio;
  int samples = 2;  ///< per pixel along x and y
  uint64_t seed = 1;
  int num_threads = 0;                        ///< 0: all cores
  std::string command;                        ///< information for people.json
  std::function<bool(double)> progress = {};  ///< called with the finished fraction; false: stop
  [[nodiscard]] bool IsValid(std::string* why) const;
};

struct MakeMultiPersonDatasetSummary {
  bool finished = false;  ///< false: stopped by `progress`
  int images = 0;
  /// Number of ordered pairs of two different frames of one person that training may draw.
  int64_t pairs = 0;
  double seconds = 0;
};

/// Writes the dataset into `folder`. The motions must have y up and a regular clock. Throws std::invalid_argument when
/// options are out of range or a motion cannot be used, std::runtime_error naming the file that cannot be written.
MakeMultiPersonDatasetSummary MakeMultiPersonDataset(const std::string& folder, const BodyModel& body,
                                                     const std::vector<Motion>& motions,
                                                     const MakeMultiPersonDatasetOptions& options = {});

}  // namespace bodyloom
