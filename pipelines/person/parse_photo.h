// SPDX-License-Identifier: Apache-2.0
/// Clothes, hair and skin of the person in a photo: what `bodyloom parse` does.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bodyloom/data_tools/datasets/single_person_dataset.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/person/clothes_parser.h"
#include "bodyloom/pipelines/person/photo_person_builder.h"
#include "bodyloom/pipelines/track/track_request.h"

namespace bodyloom {

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
  TrackRequest fit;     ///< as FitPhoto() takes it
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
