// SPDX-License-Identifier: Apache-2.0
/// Training data of the one-photo renderers from a multi-person dataset.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// What a renderer is given of a dataset's people when it is trained or scored on them; of a photo of anybody else they
/// are estimates.
inline constexpr const char* kGivenOfPeople = "true labels and bodies";

/// The same, where some of it is estimated as it is of anybody else.
struct GivenOfPeople {
  bool estimated_labels =
      false;  ///< of photos: found around the given body (SegmentPerson), clothes by the parser, not the true ones
  std::string track;  ///< name of a track in each clip's folder, of its frames: the bodies; empty: the true
  bool iuv = false;   ///< what pixels show of the body is what the clips' IUV images say

  [[nodiscard]] bool IsTrue() const { return !estimated_labels && track.empty() && !iuv; }
};

/// "true labels and bodies", or what is in place of it.
std::string ToText(const GivenOfPeople& given);

struct PeopleDataRequest {
  std::string data;  ///< a multi-person dataset, or a single-person dataset (one person, all for training)
  std::string body;  ///< empty: the built-in body
  int size = 256;    ///< of the windows
  int texture_size = 256;
  bool test = false;  ///< the people kept for testing, instead of those to train on
  GivenOfPeople given;
  /// Bodies are off by a mean projection error (data_tools/synthesis/clips/perturbed_motion.h) of 0 to this, each clip
  /// by its own, as fitted bodies are; pixels, in a picture whose longer side has 512.
  double body_error_px = 0;
  uint64_t seed = 1;            ///< of those errors
  bool labels_of_body = false;  ///< estimated labels are those of SegmentPerson alone: the parser's beginning
};

/// Pictures are read when they are first requested and kept (4 bytes a pixel); maps are made each time.
class PeopleData {
 public:
  /// Throws std::runtime_error naming the file that cannot be used or is missing, or a dataset without such people.
  explicit PeopleData(const PeopleDataRequest& request);
  ~PeopleData();
  PeopleData(const PeopleData&) = delete;
  PeopleData& operator=(const PeopleData&) = delete;

  /// Refers to this, which must outlive it.
  [[nodiscard]] const PhotoSource& source() const;
  /// The frame as a photo: as source().fill gives it, with estimated labels where those are requested. Throws
  /// std::runtime_error naming the clip where the body is not in the picture.
  [[nodiscard]] PhotoFrame PhotoOf(int person, int frame) const;
  /// The body in the frame's window: a track of one frame, whose camera's image is the window.
  [[nodiscard]] Track BodyOf(int person, int frame) const;
  [[nodiscard]] const std::shared_ptr<const BodyModel>& body() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether the dataset `data` has people kept for testing. Throws as PeopleData.
bool HasTestPeople(const std::string& data);

/// People to train a renderer on, and those who are kept for validation, where there are any.
struct TrainingPeople {
  /// In windows and textures of these sizes. Throws as PeopleData.
  TrainingPeople(const std::string& data, const std::string& body, int size, int texture_size);
  PeopleData train;
  std::unique_ptr<PeopleData> test;
};

template <class Options>
struct TrainOnPeopleRequest {
  std::string data;     ///< a multi-person dataset, or a single-person dataset (one person, all for training)
  std::string body;     ///< the people's body; empty: the built-in body
  std::string out;      ///< folder of the run: config.json, checkpoint.bin, metrics.csv, previews
  std::string weights;  ///< folder with trained weights (pipelines/neural/weights_folder.h); empty: none
  /// Configuration and numbers; what follows from files (people, reach, weights, run_dir) is filled in by the job.
  Options options;
};

/// The numbers of all its people.
std::vector<int> Everybody(const PhotoSource& source);

}  // namespace bodyloom
