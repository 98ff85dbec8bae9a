// SPDX-License-Identifier: Apache-2.0
/// What the clothes parser learns from: the pictures of a multi-person dataset, as users' photos are fitted.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "neural/parser/packed_picture.h"
#include "pipelines/neural/photo/people_data.h"

namespace bodyloom {

// Pictures to learn from, made person by person on several threads.

struct PicturesOfPeopleRequest {
  std::string data;          ///< a multi-person dataset
  std::string body;          ///< empty: the built-in body
  bool test = false;         ///< the people kept for testing, instead of those to train on
  int size = 512;            ///< of the windows
  double body_error_px = 4;  ///< bodies are off by up to this, each clip by its own: PeopleDataRequest
  uint64_t seed = 1;         ///< of those errors
  int threads = 1;
};

/// The people, with labels of the nearest part of the body and bodies that are off.
PeopleDataRequest AsPhotosShowThem(const PicturesOfPeopleRequest& request);

/// pictures_of(person) of all people, in their order, for any number of threads. Throws what it throws, Cancelled; the
/// stage of `callbacks` is `stage`.
std::vector<PackedPicture> PicturesByPerson(int num_people, int threads, const char* stage,
                                            const PipelineCallbacks& callbacks,
                                            const std::function<std::vector<PackedPicture>(int)>& pictures_of);

/// The median of people's sizes, pixels a metre; of at least one picture.
double MedianPersonSize(const std::vector<PackedPicture>& pictures);

/// Masks are found by GrabCut around the bodies, which are not quite right. Planes of kParserPlanes, truth of
/// ParserTruth; person by person, the same for any number of threads. Frames whose body is not known are left out.
/// Throws as PeopleData, Cancelled; the stage of `callbacks` is `stage`.
std::vector<PackedPicture> ParserPicturesOf(const PicturesOfPeopleRequest& request, const char* stage,
                                            const PipelineCallbacks& callbacks);

// The pictures that a picture U-Net (neural/parser/packed_picture.h) is trained and measured on, and the record of
// them.

struct PicturesToLearnFrom {
  std::vector<PackedPicture> train;  ///< one at least
  std::vector<PackedPicture> test;   ///< empty where the dataset keeps nobody for testing
};

/// `pictures_of(test)` of both halves of the dataset `data`, as two works of the caller's. Throws std::runtime_error
/// where there is no picture to train on, and what pictures_of() throws.
PicturesToLearnFrom MakePicturesToLearnFrom(const std::string& data, const PipelineCallbacks& callbacks,
                                            const std::function<std::vector<PackedPicture>(bool test)>& pictures_of);

/// What config.json and the weights' recipe say of a training by `program`.
nlohmann::ordered_json RecipeOf(const std::string& program, const PicturesOfPeopleRequest& people,
                                const PicturesToLearnFrom& pictures, const PictureTraining& training);

}  // namespace bodyloom
