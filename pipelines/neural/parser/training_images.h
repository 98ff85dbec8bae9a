// SPDX-License-Identifier: Apache-2.0
/// Makes the training images of the clothes parser from a multi-person dataset, with bodies as inexact as fits to
/// users' photos.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/parser/packed_image.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {

// Images made person by person on several threads.

struct ImagesOfPeopleRequest {
  std::string data;          ///< a multi-person dataset
  std::string body;          ///< empty: the built-in body
  bool test = false;         ///< the test people instead of the training people
  int size = 512;            ///< of the windows
  double body_error_px = 4;  ///< maximum error of the bodies, drawn per clip: PeopleDataRequest
  uint64_t seed = 1;         ///< of those errors
  int threads = 1;
};

/// Request for the people with labels of the nearest part of the body, and with body errors.
PeopleDataRequest WithEstimatedLabels(const ImagesOfPeopleRequest& request);

/// Concatenates images_of(person) of all people in order; the result is the same for any number of threads. Throws what
/// it throws, Cancelled; the stage of `callbacks` is `stage`.
std::vector<PackedImage> ImagesByPerson(int num_people, int threads, const char* stage,
                                        const PipelineCallbacks& callbacks,
                                        const std::function<std::vector<PackedImage>(int)>& images_of);

/// Median of the people's scales, pixels per metre; at least one image.
double MedianPersonSize(const std::vector<PackedImage>& images);

/// Training images of the parser: planes of kParserPlanes with the truth of ParserTruth. Masks are found by GrabCut
/// around the inexact bodies. Ordered by person; the result is the same for any number of threads. Frames without a
/// known body are left out. Throws as PeopleData, Cancelled; the stage of `callbacks` is `stage`.
std::vector<PackedImage> ParserImagesOf(const ImagesOfPeopleRequest& request, const char* stage,
                                        const PipelineCallbacks& callbacks);

// Images for training and testing an image U-Net (neural/parser/packed_image.h), and their record.

struct TrainingImages {
  std::vector<PackedImage> train;  ///< at least one
  std::vector<PackedImage> test;   ///< empty if the dataset has no test people
};

/// `images_of(test)` of both parts of the dataset `data`, as two jobs of the caller's. Throws std::runtime_error
/// without a training image, and what images_of() throws.
TrainingImages MakeTrainingImages(const std::string& data, const PipelineCallbacks& callbacks,
                                  const std::function<std::vector<PackedImage>(bool test)>& images_of);

/// Recipe of a training by `program`, stored in config.json and in the weights.
nlohmann::ordered_json RecipeOf(const std::string& program, const ImagesOfPeopleRequest& people,
                                const TrainingImages& images, const ImageTraining& training);

}  // namespace bodyloom
