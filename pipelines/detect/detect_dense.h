// SPDX-License-Identifier: Apache-2.0
/// One person's dense keypoints through a video, by a detector that the caller brings (DensePose, for one:
/// pipelines/neural/densepose_detector.h).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "data_tools/observations/people.h"
#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/label_image.h"
#include "geometry/scene/observations.h"
#include "pipelines/detect/detect_people.h"
#include "render/image/image.h"
#include "tracking/detection/iuv_to_dense.h"

namespace bodyloom {

/// Everybody in a picture. Called by one thread at a time.
using ChartDetector = std::function<std::vector<ChartDetection>(const Image& picture)>;

struct DetectDenseRequest {
  std::string video;  ///< the video, or a folder of images
  FrameSpan span;
  int person = 0;              ///< 0 is the largest and longest in view
  IuvToDenseOptions sampling;  ///< keypoints of a frame
};

struct DetectedDense {
  DenseSequence dense;  ///< noise as that of DensePose images (iuv_to_dense.h)
  int people = 0;       ///< found in the whole clip; those of `landmarks` when they were given
  int frames_seen = 0;  ///< frames in which the person was seen
};

/// Dense keypoints of one person on the faces of `body`. Without `landmarks` the detections' boxes are joined into
/// people (LinkPeople) and one of them chosen. With `landmarks`, everybody's in the very frames of the span, the person
/// is PersonOf() those; a detection belongs to the person whose landmarks' rectangle it overlaps most (intersection
/// over union), and of several that belong to the chosen one the one with most overlap is taken.
/// Throws std::runtime_error when the video cannot be used, nobody was found or there are not that many people;
/// RequestError for a span that holds no frame; std::invalid_argument when the body has no charts; Cancelled.
DetectedDense DetectDense(const DetectDenseRequest& request, const ChartDetector& detector, const BodyModel& body,
                          const PeopleSequence* landmarks = nullptr, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
