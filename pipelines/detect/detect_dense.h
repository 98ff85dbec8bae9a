// SPDX-License-Identifier: Apache-2.0
/// Detects one person's dense keypoints in a video, by a detector that the caller provides (such as DensePose,
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

/// Detects everybody in an image. Called by one thread at a time.
using ChartDetector = std::function<std::vector<ChartDetection>(const Image& image)>;

struct DetectDenseRequest {
  std::string video;  ///< the video, or a folder of images
  FrameSpan span;
  int person = 0;              ///< 0 is the largest and longest in view
  IuvToDenseOptions sampling;  ///< keypoints of a frame
};

struct DetectedDense {
  DenseSequence dense;  ///< noise of DensePose images (iuv_to_dense.h)
  int people = 0;       ///< number found in the clip; those of `landmarks` if given
  int frames_seen = 0;  ///< frames in which the person was seen
};

/// Dense keypoints of one person on the faces of `body`. Without `landmarks` the boxes of the detections are linked to
/// people (LinkPeople) and one of them is selected. With `landmarks` of everybody in exactly the frames of the span,
/// the person is selected by PersonOf(); each detection is assigned to the person whose bounding box of landmarks has
/// the largest IoU with it, and of several detections assigned to the selected person the one with the largest IoU is
/// used. Throws std::runtime_error when the video cannot be used, nobody was found or there are not that many people;
/// RequestError for a span that holds no frame; std::invalid_argument when the body has no charts; Cancelled.
DetectedDense DetectDense(const DetectDenseRequest& request, const ChartDetector& detector, const BodyModel& body,
                          const PeopleSequence* landmarks = nullptr, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
