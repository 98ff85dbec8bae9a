// SPDX-License-Identifier: Apache-2.0
/// Renderers that need one photo, on people they have not seen, under one protocol: what `bodyloom animate photo
/// --score`, `bodyloom animate guided --score` and `bodyloom animate person --score` do.
///
/// Of each test person the photos are those of ChoosePhotos (neural/guided/choose_photos.h) on true labels and bodies,
/// whatever is given to the renderer; the pictures to compare with are spread over the others. So all renderers, and
/// every setting of one, draw the same pictures from the same photos, and one class measures them (PersonScorer).
/// Windows of the networks have the size of the run's profile: runs to be compared are of one image size. Where bodies
/// are estimated the windows follow them.
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
  kWarp     ///< the floor: the bare body as far as the photos show it, black elsewhere
};

struct ScorePeopleRequest {
  PeopleRenderer renderer = PeopleRenderer::kPhoto;
  std::string run;                ///< folder of the trained run; of the others: empty
  int size = 256;                 ///< of the windows, of what has no run
  int texture_size = 512;         ///< texels a side, of kPerson
  std::string data;               ///< a multi-person dataset: its test people
  std::string body;               ///< empty: the built-in body
  GivenOfPeople given;            ///< of photos and poses
  std::vector<int> photos = {1};  ///< numbers of photos to animate from, each scored: 1, 2, 4
  int frames = 8;                 ///< of each person, spread over those that none of the numbers takes for photos
  bool anywhere = false;          ///< people may be farther from the body than clothes ever were in training
  /// Of what the photos do not show; absent: as the run says. Of the pose-guided renderer alone.
  std::optional<MapCompletion> completion;
  /// A contact sheet to write, a row a person: the photo, then what it shows of the pose, result, truth for the first
  /// number of photos; empty: none.
  std::string sheet;
  std::string weights;         ///< folder with alexnet, lpips_alex and vgg19 (weights_folder.h); empty: none
  std::string json;            ///< a report to write; empty: none
  int threads = 0;             ///< 0: all cores
  std::string device = "cpu";  ///< where the networks run: "cpu" or "cuda"
};

struct ScoredPhotos {
  int photos = 0;
  PersonScores scores;     ///< SSIM of the windows by pipelines/neural/weights_folder.h
  double texels_seen = 0;  ///< share of the atlas that the photos fill, mean over people
  int missing = 0;         ///< people of whom the photos show too little: drawn as nobody, and counted
};

struct ScorePeopleSummary {
  std::string given;                 ///< in words
  std::vector<ScoredPhotos> scored;  ///< in the order of the request's numbers of photos
  std::vector<std::string> written;  ///< the files, as the request names them
};

/// Throws std::runtime_error for files that cannot be used and datasets without a picture to compare with, RequestError
/// for what the renderer has not, Cancelled. The stage of `callbacks` is "people".
ScorePeopleSummary ScorePeople(const ScorePeopleRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
