// SPDX-License-Identifier: Apache-2.0
/// The pictures that a picture U-Net (neural/pictures/picture_training.h) is trained and measured on, and the record of them.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bodyloom/neural/pictures/packed_picture.h"
#include "bodyloom/neural/pictures/picture_training.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/neural/people/pictures_by_person.h"

namespace bodyloom {

struct PicturesToLearnFrom {
  std::vector<PackedPicture> train;  ///< one at least
  std::vector<PackedPicture> test;   ///< empty where the dataset keeps nobody for testing
};

/// `pictures_of(test)` of both halves of the dataset `data`, as two works of the caller's. Throws std::runtime_error where
/// there is no picture to train on, and what pictures_of() throws.
PicturesToLearnFrom MakePicturesToLearnFrom(const std::string& data, const PipelineCallbacks& callbacks,
                                            const std::function<std::vector<PackedPicture>(bool test)>& pictures_of);

/// What config.json and the weights' recipe say of a training by `program`.
nlohmann::ordered_json RecipeOf(const std::string& program, const PicturesOfPeopleRequest& people,
                                const PicturesToLearnFrom& pictures, const PictureTraining& training);

}  // namespace bodyloom
