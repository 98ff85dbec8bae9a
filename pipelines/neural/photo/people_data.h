// SPDX-License-Identifier: Apache-2.0
/// Provides training data of the one-photo renderers from a multi-person dataset.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Text of the renderer's input in training and scoring on a dataset; for other photos labels and bodies are estimates.
inline constexpr const char* kGivenOfPeople = "true labels and bodies";

/// Parts of the renderer's input that are estimated instead of true.
struct GivenOfPeople {
  bool estimated_labels =
      false;  ///< of photos: found around the given body (SegmentPerson), clothes by the parser, not the true ones
  std::string track;  ///< name of a track in each clip's folder that gives the bodies; empty: the truth
  bool iuv = false;   ///< surface coordinates of pixels come from the clips' IUV images

  [[nodiscard]] bool IsTrue() const { return !estimated_labels && track.empty() && !iuv; }
};

/// "true labels and bodies", or the estimates that replace them.
std::string ToText(const GivenOfPeople& given);

struct PeopleDataRequest {
  std::string data;  ///< a multi-person dataset, or a single-person dataset (one person, all for training)
  std::string body;  ///< empty: the built-in body
  int size = 256;    ///< of the windows
  int texture_size = 256;
  bool test = false;  ///< the test people instead of the training people
  GivenOfPeople given;
  /// Maximum error of the bodies: each clip has a mean projection error (data_tools/synthesis/clips/perturbed_motion.h)
  /// between 0 and this, as fitted bodies do; pixels, in an image whose longer side has 512.
  double body_error_px = 0;
  uint64_t seed = 1;            ///< of those errors
  bool labels_of_body = false;  ///< estimated labels are those of SegmentPerson alone, the parser's input
};

/// Images are read on first use and kept (4 bytes per pixel); maps are recomputed each time.
class PeopleData {
 public:
  /// Throws std::runtime_error naming a file that cannot be used or is missing, or a dataset without the requested
  /// people.
  explicit PeopleData(const PeopleDataRequest& request);
  ~PeopleData();
  PeopleData(const PeopleData&) = delete;
  PeopleData& operator=(const PeopleData&) = delete;

  /// Source of photos; refers to this object, which must outlive it.
  [[nodiscard]] const PhotoSource& source() const;
  /// The frame as a photo, as given by source().fill, with estimated labels if requested. Throws std::runtime_error
  /// naming the clip if the body is not in the image.
  [[nodiscard]] PhotoFrame PhotoOf(int person, int frame) const;
  /// The body in the frame's window: a track of one frame, whose camera's image is the window.
  [[nodiscard]] Track BodyOf(int person, int frame) const;
  [[nodiscard]] const std::shared_ptr<const BodyModel>& body() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Returns true if the dataset `data` has test people. Throws as PeopleData.
bool HasTestPeople(const std::string& data);

/// People for training a renderer, and for validation if there are any.
struct TrainingPeople {
  /// Reads people in windows and textures of these sizes. Throws as PeopleData.
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
  /// Configuration and hyperparameters; fields that depend on files (people, reach, weights, run_dir) are set by the
  /// job.
  Options options;
};

/// Indices of all people of the source.
std::vector<int> Everybody(const PhotoSource& source);

}  // namespace bodyloom
