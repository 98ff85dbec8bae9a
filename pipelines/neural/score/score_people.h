// SPDX-License-Identifier: Apache-2.0
/// Scores renderers that need only photos, on people not seen in training, under one protocol; implements `bodyloom
/// animate photo --score`, `bodyloom animate guided --score` and `bodyloom animate person --score`.
///
/// The photos of each test person are selected by ChoosePhotos (neural/guided/choose_photos.h) on true labels and
/// bodies, whatever the renderer is given; the target images are spread over the other frames. All renderers and
/// settings thus draw the same images from the same photos, measured by one class (PersonScorer). The networks' windows
/// have the size of the run's profile, so runs are only comparable at equal image size. If bodies are estimated,
/// windows follow the estimates.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/guided/guided_config.h"
#include "neural/metrics/person_scores.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {

enum class PeopleRenderer {
  kPhoto,   ///< the one-photo renderer of a run (pipelines/neural/photo)
  kGuided,  ///< the pose-guided renderer of a run (pipelines/neural/guided)
  kPerson,  ///< a textured body with clothes, nothing trained (render/photo_avatar)
  kWarp     ///< baseline: the bare body where the photos show it, black elsewhere
};

struct ScorePeopleRequest {
  PeopleRenderer renderer = PeopleRenderer::kPhoto;
  std::string run;                ///< folder of the trained run; empty for kPerson and kWarp
  int size = 256;                 ///< of the windows, for renderers without a run
  int texture_size = 512;         ///< texels a side, of kPerson
  std::string data;               ///< a multi-person dataset: its test people
  std::string body;               ///< empty: the built-in body
  GivenOfPeople given;            ///< of photos and poses
  std::vector<int> photos = {1};  ///< numbers of photos used, each scored: 1, 2, 4
  int frames = 8;                 ///< per person, spread over the frames that no number uses as photos
  bool whole_window = false;      ///< clothes may be farther from the body than any in training
  /// Completion of what the photos do not show, for the pose-guided renderer only; absent: as in the run.
  std::optional<MapCompletion> completion;
  /// Contact sheet to write, one row per person: photo, its warp to the pose, result and truth, for the first number of
  /// photos; empty: none.
  std::string sheet;
  std::string weights;         ///< folder with alexnet, lpips_alex and vgg19 (weights_folder.h); empty: none
  std::string json;            ///< a report to write; empty: none
  int threads = 0;             ///< 0: all cores
  std::string device = "cpu";  ///< device of the networks: "cpu" or "cuda"
};

struct ScoredPhotos {
  int photos = 0;
  PersonScores scores;     ///< SSIM of the windows by pipelines/neural/weights_folder.h
  double texels_seen = 0;  ///< share of the atlas covered by the photos, mean over people
  int missing = 0;         ///< people whose photos show too little, scored as empty images
};

struct ScorePeopleSummary {
  std::string given;                 ///< ToText(GivenOfPeople)
  std::vector<ScoredPhotos> scored;  ///< in the order of the request's numbers of photos
  std::vector<std::string> written;  ///< the files, as the request names them
};

/// Scores the renderer. Throws std::runtime_error for files that cannot be used and datasets without a target image,
/// RequestError for options that the renderer does not support, Cancelled. The stage of `callbacks` is "people".
ScorePeopleSummary ScorePeople(const ScorePeopleRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
