// SPDX-License-Identifier: Apache-2.0
/// A person made from photos: people are detected, one is fitted to landmarks and mask, clothes are labelled, and the
/// surface gets its texture.
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

/// The body, the detector, the focal length, the person's height and how to solve. The video is the photo.
struct PhotoFitSettings : TrackSettings {
  int person = 0;  ///< who of a photo; 0: the largest
};

/// The person of the photo at `path`; `body` becomes what was fitted. `clock` times the stages "read", "detect" and
/// "fit". Throws RequestError for a request that contradicts itself, NothingToTrack naming a photo in which nobody is
/// found or could be fitted, std::runtime_error naming a file that cannot be used, Cancelled.
FittedPhoto FitPhoto(const PhotoFitSettings& fit, const std::string& path, const PipelineCallbacks& callbacks,
                     StageClock* clock, std::shared_ptr<const BodyModel>* body);

// Photos of a person to a body and a texture (photo_person.h). Nothing is trained and no video is needed.
//
// Each photo by itself: people are detected and the body is fitted to the person's landmarks and mask. What the fitted
// photos show becomes the person (photo_person_builder.h).

struct PhotoPersonRequest {
  std::vector<std::string> images;  ///< photos of the person, at least one
  PhotoFitSettings fit;
  int texture_size = 1024;    ///< texels a side, 64 to 8192
  bool loose_garment = true;  ///< look for a skirt, dress or coat
};

/// Throws RequestError for a request that contradicts itself, NothingToTrack naming a photo in which nobody is found or
/// could be fitted, std::runtime_error naming a file that cannot be used, Cancelled.
PhotoPerson MakePhotoPerson(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks = {});

// Clothes, hair and skin of the person in a photo: what `bodyloom parse` does.

/// The clothes parser that ships (BuiltinParser()).
inline constexpr const char* kBuiltinParser = "builtin";
/// Every pixel of the person's mask shows what the nearest pixel of the fitted body does (LabelOfPart()): no parser.
inline constexpr const char* kNearestOfBody = "body";

/// The labels (PersonLabel) of a fitted photo, one a pixel of it; `parser` nullptr: kNearestOfBody. `body` is what was
/// fitted.
std::vector<uint8_t> LabelsOfPhoto(const FittedPhoto& photo, const BodyModel& body, ClothesParser* parser,
                                   int num_threads);

/// A picture of labels: a label's number in all channels.
Image NumbersPicture(std::span<const uint8_t> labels, int width, int height);

struct PhotoParseRequest {
  std::string image;
  /// Or kNearestOfBody, or a file (data_tools/learned/parser_weights_io.h).
  std::string weights = kBuiltinParser;
  std::string out;      ///< the labels, .png: a label's number in all channels; empty: none
  std::string picture;  ///< the photo, tinted by label, .png or .jpg; empty: none
  PhotoFitSettings fit;
};

struct PhotoParseSummary {
  int width = 0, height = 0;
  std::vector<uint8_t> labels;                 ///< PersonLabel, one a pixel
  std::array<int, kNumPersonLabels> pixels{};  ///< by label
  std::vector<std::string> written;
  StageSeconds seconds;
};

/// Throws RequestError for a request that contradicts itself, and as FitPhoto().
PhotoParseSummary ParsePhoto(const PhotoParseRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
