// SPDX-License-Identifier: Apache-2.0
/// Makes a person from photos: detects people, fits the body to one person's landmarks and mask, labels clothes, and
/// textures the surface.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/body_model.h"
#include "pipelines/track/track_request.h"
#include "render/photo_avatar/photo_person.h"
#include "render/photo_avatar/photo_person_builder.h"
#include "tracking/detection/clothes_parser.h"

namespace bodyloom {

/// Settings of a fit to a photo: body, detector, focal length, the person's height and the solver. The video is the
/// photo.
struct PhotoFitSettings : TrackSettings {
  int person = 0;  ///< index of the person in a photo; 0: the largest
};

/// Fits the person of the photo at `path`; `body` is set to the body that was fitted. `clock` times the stages "read",
/// "detect" and "fit". Throws RequestError for a contradictory request, NoPersonFound naming a photo in which nobody is
/// found or can be fitted, std::runtime_error naming a file that cannot be used, Cancelled.
FittedPhoto FitPhoto(const PhotoFitSettings& fit, const std::string& path, const PipelineCallbacks& callbacks,
                     StageClock* clock, std::shared_ptr<const BodyModel>* body);

// Photos of a person to a body with a texture (photo_person.h), without training or video. People are detected in each
// photo separately and the body is fitted to the person's landmarks and mask; the fitted photos are merged by
// photo_person_builder.h.

struct PhotoPersonRequest {
  std::vector<std::string> images;  ///< photos of the person, at least one
  PhotoFitSettings fit;
  int texture_size = 1024;    ///< texels a side, 64 to 8192
  bool loose_garment = true;  ///< detect a skirt, dress or coat
};

/// Makes the person. Throws RequestError for a contradictory request, NoPersonFound naming a photo in which nobody is
/// found or can be fitted, std::runtime_error naming a file that cannot be used, Cancelled.
PhotoPerson MakePhotoPerson(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks = {});

// Labels of clothes, hair and skin of the person in a photo; implements `bodyloom parse`.

/// The built-in clothes parser (BuiltinParser()).
inline constexpr const char* kBuiltinParser = "builtin";
/// No parser: each pixel of the person's mask takes the label of the nearest pixel of the fitted body (LabelOfPart()).
inline constexpr const char* kNearestOfBody = "body";

/// Labels (PersonLabel) of a fitted photo, one per pixel; `parser` nullptr: kNearestOfBody. `body` is the body that was
/// fitted.
std::vector<uint8_t> LabelsOfPhoto(const FittedPhoto& photo, const BodyModel& body, ClothesParser* parser,
                                   int num_threads);

/// Label image: each label's number in all channels.
Image NumbersImage(std::span<const uint8_t> labels, int width, int height);

struct PhotoParseRequest {
  std::string image;
  /// kBuiltinParser, kNearestOfBody, or a file (data_tools/learned/parser_weights_io.h).
  std::string weights = kBuiltinParser;
  std::string out;      ///< the labels, .png: a label's number in all channels; empty: none
  std::string picture;  ///< the photo, tinted by label, .png or .jpg; empty: none
  PhotoFitSettings fit;
};

struct PhotoParseSummary {
  int width = 0, height = 0;
  std::vector<uint8_t> labels;                 ///< PersonLabel, one per pixel
  std::array<int, kNumPersonLabels> pixels{};  ///< by label
  std::vector<std::string> written;
  StageSeconds seconds;
};

/// Parses the photo. Throws RequestError for a contradictory request, and as FitPhoto().
PhotoParseSummary ParsePhoto(const PhotoParseRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
