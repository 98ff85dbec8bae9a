// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/photo_person.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bodyloom/data_tools/motion/shape_track.h"
#include "bodyloom/data_tools/observations/nothing_to_track.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/bake_shape.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/percentile.h"
#include "bodyloom/pipelines/track/detected_people.h"
#include "bodyloom/pipelines/track/scene_inputs.h"
#include "bodyloom/render/overlay.h"
#include "bodyloom/render/person/body_regions.h"
#include "bodyloom/render/person/clothes_offsets.h"
#include "bodyloom/render/person/whole_texture.h"
#include "bodyloom/render/texture_extract.h"
#include "bodyloom/render/unit_byte.h"
#include "bodyloom/tracking/track_sequence.h"

namespace bodyloom {
namespace {

constexpr int kSmallestTexture = 64, kLargestTexture = 8192;
constexpr double kMarginOfHeight = 0.004;  ///< of the person's pixels: the mask's contour is blurred by so much

constexpr double kStepMarginOfHeight = 0.012;  ///< where a limb hides another: a fit's median error
constexpr double kLeastSeen = 0.01;            ///< of the body's texels, in every photo

/// In the order of TexelSource.
constexpr std::array<Colour, 8> kSourceColours = {{{0, 0, 0},
                                                   {255, 255, 255},
                                                   {70, 110, 230},
                                                   {60, 180, 90},
                                                   {230, 210, 60},
                                                   {130, 80, 40},
                                                   {240, 140, 40},
                                                   {220, 40, 60}}};

/// One photo, understood.
struct FittedPhoto {
  Image image;
  Track track;
  LabelImage mask;
};

class PhotoPersonMaker {
 public:
  PhotoPersonMaker(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks) {
    if (request.images.empty()) throw RequestError("--image is required: a photo of the person");
    if (request.texture_size < kSmallestTexture || request.texture_size > kLargestTexture) {
      throw RequestError(Concatenate("--texture-size ", request.texture_size, ": expected ", kSmallestTexture, " to ",
                                     kLargestTexture));
    }
  }

  PhotoPerson Run() {
    for (size_t i = 0; i < request_.images.size(); ++i) {
      callbacks_.Update("photos", static_cast<double>(i) / static_cast<double>(request_.images.size()));
      AddPhoto(request_.images[i], static_cast<int>(i));
    }
    Complete();
    clock_.End();
    person_.report.seconds = clock_.seconds();
    return std::move(person_);
  }

 private:
  FittedPhoto Fit(const std::string& path, PhotoPersonReport::Photo* report) {
    TrackRequest request = request_.fit;
    request.video = path;
    request.out = "-";  // nothing is written: the check wants to know where to
    CheckTrackRequest(request);
    FittedPhoto photo;
    clock_.Begin("read");
    photo.image = ReadImage(path);
    SceneInputs scene = LoadSceneInputs(request);
    UseFocal(request, &scene.camera.camera);
    clock_.Begin("detect");
    const DetectedClip clip = DetectForTracking(request, callbacks_);
    const std::vector<PersonTrack> everybody = LinkPeople(clip.people);
    if (everybody.empty()) throw NothingToTrack(path + ": nobody was found in the photo");
    report->people = static_cast<int>(everybody.size());
    const PersonTrack who = PersonOf(clip.people, request.person, path);
    DetectedObservations seen = ObservationsOf(clip, who, WholeClip(clip), request, scene);
    if (!seen.mask || seen.mask->frames.empty()) {
      throw RequestError("a person from a photo needs the mask of BlazePose: not with --pose-model or --no-mask");
    }
    clock_.Begin("fit");
    TrackSequenceInput input = scene.ForTracker();
    input.keypoints = &seen.keypoints;
    input.part_labels = &*seen.mask;
    TrackSequenceOptions options = request.solve;
    options.camera_knowledge = scene.camera_knowledge;
    options.straight_knees_weight = StraightKneesWeight(request, seen.keypoints.convention);
    TrackSequenceResult result = TrackSequence(input, options);
    if (!result.summary.IsUsable() || !result.track.motion.HasPose(0)) {
      throw NothingToTrack(path + ": the person could not be fitted: " + result.summary.message);
    }
    photo.track = std::move(result.track);
    photo.mask = MaskOfPerson(clip, who).frames.at(0);
    person_.bare = scene.body;
    report->image = path, report->width = photo.image.width, report->height = photo.image.height;
    return photo;
  }

  void AddPhoto(const std::string& path, int index) {
    PhotoPersonReport::Photo report;
    const FittedPhoto photo = Fit(path, &report);
    clock_.Begin("clothes");
    const BodyModel& bare = *person_.bare;
    if (!bare.has_uv()) throw std::runtime_error(request_.fit.body + ": has no UV coordinates, a texture needs them");
    const Eigen::VectorXd betas = photo.track.motion.betas;
    const ClothesOffsets offsets = FitClothesOffsets(
        bare, ShapeVertices(bare, betas), TrackVertices(bare, photo.track, 0), photo.track.CameraAt(0), photo.mask);
    report.rim_measured = offsets.measured;
    const auto clothed = std::make_shared<const BodyModel>(BakeShape(bare, betas, offsets.metres));
    if (index == 0) {
      person_.betas = betas;
      person_.body = clothed;
      person_.report.clothes_median_m = Percentile(offsets.metres, 50);
      person_.report.clothes_max_m = *std::max_element(offsets.metres.begin(), offsets.metres.end());
    }
    clock_.Begin("texture");
    if (!extractor_) {
      TextureExtractOptions options;
      options.texels.width = options.texels.height = request_.texture_size;
      options.edge_margin_px = MarginPx(photo.mask, kMarginOfHeight);
      options.step_margin_px = MarginPx(photo.mask, kStepMarginOfHeight);
      options.merge = TextureExtractOptions::Merge::kMean;
      options.keep = 1;
      extractor_.emplace(*person_.body, options);
    }
    Track track = photo.track;
    track.motion.betas.setZero();
    std::vector<uint8_t> person(static_cast<size_t>(photo.image.width) * photo.image.height);
    for (int y = 0; y < photo.image.height; ++y) {
      for (int x = 0; x < photo.image.width; ++x) {
        person[static_cast<size_t>(y) * photo.image.width + x] = photo.mask.At(x, y);
      }
    }
    const int seen = extractor_->Add(photo.image, TrackVertices(*clothed, track, 0), track.CameraAt(0), index, person);
    report.texels_seen = static_cast<double>(seen) / extractor_->table().num_inside;
    if (report.texels_seen < kLeastSeen) {
      throw NothingToTrack(Concatenate(path, ": shows too little of the person, expected one who is larger (",
                                       MaskHeight(photo.mask), " px tall here) and turned to the camera"));
    }
    person_.report.photos.push_back(report);
    person_.tracks.push_back(photo.track);
  }

  /// Pixels from the mask's first row to its last.
  static int MaskHeight(const LabelImage& mask) {
    int first = mask.height, last = -1;
    for (int y = 0; y < mask.height; ++y) {
      for (int x = 0; x < mask.width; ++x) {
        if (mask.labels[static_cast<size_t>(y) * mask.width + x] == 0) continue;
        first = std::min(first, y), last = std::max(last, y);
      }
    }
    return std::max(0, last - first + 1);
  }
  static int MarginPx(const LabelImage& mask, double of_height) {
    return static_cast<int>(std::clamp(std::lround(of_height * MaskHeight(mask)), 1L, 64L));
  }

  void Complete() {
    clock_.Begin("complete");
    const MatrixX3d rest = ShapeVertices(*person_.bare, person_.betas);
    const UvTexelTable& table = extractor_->table();
    const WholeTexture whole = MakeWholeTexture(*person_.body, table, person_.body->data().v_template,
                                                BodyRegions(*person_.bare, rest), extractor_->Merge());
    person_.texture = Image(table.width, table.height);
    const size_t pixels = whole.sources.size();
    for (size_t p = 0; p < pixels; ++p) {
      for (size_t c = 0; c < 3; ++c) person_.texture.bgr[3 * p + c] = UnitByte(whole.bgr[c * pixels + p]);
    }
    person_.sources = Image(table.width, table.height);
    for (size_t p = 0; p < pixels; ++p) {
      const Colour colour = kSourceColours[static_cast<size_t>(whole.sources[p])];
      person_.sources.bgr[3 * p] = colour.blue;
      person_.sources.bgr[3 * p + 1] = colour.green;
      person_.sources.bgr[3 * p + 2] = colour.red;
    }
    const auto share = [&](TexelSource source) {
      return static_cast<double>(std::count(whole.sources.begin(), whole.sources.end(), source)) / table.num_inside;
    };
    person_.report.seen = share(TexelSource::kSeen);
    person_.report.mirrored = share(TexelSource::kMirror);
    person_.report.behind = share(TexelSource::kBehind) + share(TexelSource::kAcross);
    person_.report.hair = share(TexelSource::kHair);
    person_.report.around = share(TexelSource::kAround);
    person_.report.spread = share(TexelSource::kSpread);
  }

  const PhotoPersonRequest& request_;
  const PipelineCallbacks& callbacks_;
  StageClock clock_;
  std::optional<TextureExtractor> extractor_;
  PhotoPerson person_;
};

}  // namespace

Track MovedByPerson(const PhotoPerson& person, const Track& track) {
  BODYLOOM_CHECK(!track.HasMovingCamera(), "its camera moves; expected one that stands still");
  Track moved = WithShape(*person.bare, track, person.betas);
  moved.motion.betas.setZero();
  moved.joints.clear();  // the bare body's
  return moved;
}

PhotoPerson MakePhotoPerson(const PhotoPersonRequest& request, const PipelineCallbacks& callbacks) {
  return PhotoPersonMaker(request, callbacks).Run();
}

}  // namespace bodyloom
