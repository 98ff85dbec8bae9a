// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/people/pictures_to_learn_from.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/neural/photo/people_data.h"

namespace bodyloom {

PicturesToLearnFrom MakePicturesToLearnFrom(const std::string& data, const PipelineCallbacks& callbacks,
                                            const std::function<std::vector<PackedPicture>(bool test)>& pictures_of) {
  PicturesToLearnFrom pictures;
  callbacks.Begin("people");
  pictures.train = pictures_of(false);
  if (HasTestPeople(data)) {
    callbacks.Begin("people for validation");
    pictures.test = pictures_of(true);
  }
  if (pictures.train.empty()) throw std::runtime_error(data + ": no picture to train on");
  callbacks.Say(Concatenate("training on ", pictures.train.size(), " pictures; validating on ", pictures.test.size()));
  return pictures;
}

nlohmann::ordered_json RecipeOf(const std::string& program, const PicturesOfPeopleRequest& people,
                                const PicturesToLearnFrom& pictures, const PictureTraining& training) {
  return {{"program", program},
          {"version", BODYLOOM_VERSION},
          {"data", people.data},
          {"pictures", pictures.train.size()},
          {"test_pictures", pictures.test.size()},
          {"size", people.size},
          {"body_error_px", people.body_error_px},
          {"seed", training.seed},
          {"steps", training.steps},
          {"batch", training.batch},
          {"crop", training.crop},
          {"learning_rate", training.learning_rate},
          {"weight_decay", training.weight_decay},
          {"average_share", training.average_share},
          {"light_strength", training.light_strength},
          {"device", training.device}};
}

}  // namespace bodyloom
