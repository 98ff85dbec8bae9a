// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/photo_person_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"
#include "geometry/cloth/body_with_garment.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/person_label.h"
#include "geometry/scene/track_edits.h"
#include "render/garment/clothes_offsets.h"
#include "render/garment/person_cloth.h"
#include "render/image/image.h"
#include "render/image/palette.h"
#include "render/photo_avatar/texel_labels.h"
#include "render/texture/body_regions.h"
#include "render/texture/complete/whole_texture.h"
#include "render/view/overlay.h"

namespace bodyloom {
namespace {

constexpr double kMarginOfHeight = 0.004;      ///< width of the blur at the mask's contour
constexpr double kStepMarginOfHeight = 0.012;  ///< at occlusions between limbs: median error of a fit
constexpr double kLeakOfHeight = 0.06;         ///< skin within this of the fitted arm may be the arm's
constexpr double kHemMargin_m = 0.12;          ///< below a hem, leg pixels may show the hem
constexpr double kMinSeen = 0.01;              ///< share of the body's texels that each photo must show

constexpr int kLeftKnee = 4, kRightKnee = 5;  ///< SMPL's joints; a body with a garment has them

/// Colours of TexelSource, in its order.
constexpr std::array<Colour, 8> kSourceColours = {{{0, 0, 0},
                                                   {255, 255, 255},
                                                   {70, 110, 230},
                                                   {60, 180, 90},
                                                   {230, 210, 60},
                                                   {130, 80, 40},
                                                   {240, 140, 40},
                                                   {220, 40, 60}}};

/// Height of the mask's content, pixels.
int MaskHeight(const LabelImage& mask) {
  int first = mask.height, last = -1;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (mask.labels[static_cast<size_t>(y) * mask.width + x] == 0) continue;
      first = std::min(first, y), last = std::max(last, y);
    }
  }
  return std::max(0, last - first + 1);
}

int MarginPx(const LabelImage& mask, double of_height) {
  return static_cast<int>(std::clamp(std::lround(of_height * MaskHeight(mask)), 1L, 64L));
}

}  // namespace

std::vector<uint8_t> PhotoMask(const FittedPhoto& photo) {
  return photo.mask.Over(photo.image.width, photo.image.height);
}

PhotoPersonBuilder::PhotoPersonBuilder(std::shared_ptr<const BodyModel> bare, int texture_size, StageClock* clock,
                                       const FitClothesOptions& clothes)
    : texture_size_(texture_size), clock_(clock), clothes_(clothes) {
  BODYLOOM_CHECK(bare->has_uv(), "a person's texture: the body has no UV coordinates");
  person_.bare = std::move(bare);
}

void PhotoPersonBuilder::Begin(const char* stage) {
  if (clock_ != nullptr) clock_->Begin(stage);
}

/// Fits the clothes of the photo; the garment is taken from the first photo.
ClothesOffsets PhotoPersonBuilder::Dress(const FittedPhoto& photo) {
  const BodyModel& bare = *person_.bare;
  if (person_.tracks.empty()) {
    FittedClothes fitted = FitClothes(bare, photo.track, photo.mask, clothes_);
    person_.cut = fitted.garment;
    person_.report.garment_length_m = fitted.garment.length_m;
    swing_rad_ = fitted.swing_rad;
    person_.report.mask_error_tight = fitted.mask_error_tight;
    person_.report.mask_error_with_garment = fitted.mask_error_with_garment;
    return std::move(fitted.offsets);
  }
  const MatrixX3d rest = ShapeVertices(bare, photo.track.motion.betas);
  std::vector<uint8_t> covered;
  if (!person_.garment.empty()) covered = CoveredByGarment(bare, rest, person_.cut);
  return FitClothesOffsets(bare, rest, TrackVertices(bare, photo.track, 0), photo.track.CameraAt(0), photo.mask,
                           clothes_.offsets, covered);
}

/// Removes the photo's light; the first photo's becomes the person's.
Image PhotoPersonBuilder::InEvenLight(const FittedPhoto& photo, const MatrixX3d& vertices) {
  Image image = photo.image;
  if (photo.labels.empty()) return image;
  LitSurface surface(*person_.body, !person_.garment.empty(), clothes_.num_threads);
  surface.Look(vertices, photo.track.CameraAt(0));
  const PhotoLight light = LightOfPhoto(image, photo.labels, surface);
  if (person_.tracks.empty()) person_.light.coefficients = GreyLight(light.coefficients);
  surface.Unlight(GreyLight(light.coefficients), kPhotoShading, &image);
  return image;
}

std::vector<uint8_t> PhotoPersonBuilder::UsablePixels(const FittedPhoto& photo, const MatrixX3d& vertices) const {
  std::vector<uint8_t> mask = PhotoMask(photo);
  if (photo.labels.empty()) return mask;
  const std::vector<uint8_t> parts =
      PartsInImage(*person_.body, vertices, photo.track.CameraAt(0), clothes_.num_threads);
  return WithoutLimbLeaks(photo.image, mask, photo.labels, parts, MarginPx(photo.mask, kLeakOfHeight));
}

void PhotoPersonBuilder::Add(const FittedPhoto& photo) {
  PhotoPersonReport::Photo report;
  report.image = photo.name, report.people = photo.people;
  report.width = photo.image.width, report.height = photo.image.height;
  Begin("clothes");
  const BodyModel& bare = *person_.bare;
  const Eigen::VectorXd betas = photo.track.motion.betas;
  const ClothesOffsets offsets = Dress(photo);
  report.rim_measured = offsets.measured;
  const auto clothed = std::make_shared<const BodyModel>(BakeShape(bare, betas, offsets.metres));
  const int index = static_cast<int>(person_.tracks.size());
  if (index == 0) {
    person_.betas = betas;
    person_.body = person_.clothed = clothed;
    person_.garment = {};
    if (person_.cut.length_m > 0) {
      person_.garment = CutGarment(*clothed, &person_.cut);
      person_.body = std::make_shared<const BodyModel>(BodyWithGarment(*clothed, person_.garment));
    }
    person_.report.clothes_median_m = Percentile(offsets.metres, 50);
    person_.report.clothes_max_m = *std::max_element(offsets.metres.begin(), offsets.metres.end());
  }
  Begin("texture");
  if (!extractor_) {
    TextureExtractOptions options;
    options.texels.width = options.texels.height = texture_size_;
    options.edge_margin_px = MarginPx(photo.mask, kMarginOfHeight);
    options.step_margin_px = MarginPx(photo.mask, kStepMarginOfHeight);
    options.merge = TextureExtractOptions::Merge::kMean;
    options.keep = 1;
    extractor_.emplace(*person_.body, options);
  }
  const Track track = OfBakedBody(photo.track);
  MatrixX3d vertices(person_.body->num_vertices(), 3);
  vertices.topRows(clothed->num_vertices()) = TrackVertices(*clothed, track, 0);
  if (!person_.garment.empty()) {
    const PersonClothOptions hanging = {.swing_rad = index == 0 ? swing_rad_ : 0};
    PlaceGarment(person_.garment, PersonCloth(*clothed, person_.garment, track, hanging).At(0), &vertices);
  }
  const int seen =
      extractor_->Add(InEvenLight(photo, vertices), vertices, track.CameraAt(0), index, UsablePixels(photo, vertices));
  report.texels_seen = static_cast<double>(seen) / extractor_->table().num_inside;
  if (report.texels_seen < kMinSeen) {
    if (index == 0) extractor_.reset();  // the next photo becomes the first
    throw NoPersonFound(Concatenate(photo.name, ": shows too little of the person, expected one who is larger (",
                                    MaskHeight(photo.mask), " px tall here) and turned to the camera"));
  }
  person_.report.photos.push_back(report);
  person_.tracks.push_back(photo.track);
  if (!photo.labels.empty()) labels_.push_back({photo.image.width, photo.image.height, photo.labels});
}

PhotoPerson PhotoPersonBuilder::Finish() {
  BODYLOOM_CHECK(extractor_, "a person of no photo");
  Begin("complete");
  const MatrixX3d rest = ShapeVertices(*person_.bare, person_.betas);
  const UvTexelTable& table = extractor_->table();
  std::vector<BodyRegion> regions = BodyRegions(*person_.bare, rest);
  if (!person_.garment.empty()) {
    LooseGarmentOptions longer = person_.cut;
    longer.length_m += kHemMargin_m;
    const std::vector<uint8_t> covered = CoveredByGarment(*person_.bare, rest, longer);
    const std::vector<int> strongest = StrongestJoints(*person_.bare);
    for (size_t v = 0; v < covered.size(); ++v) {
      const bool shin = strongest[v] == kLeftKnee || strongest[v] == kRightKnee;
      if (covered[v] != 0) regions[v] = BodyRegion::kUnderGarment;
      if (covered[v] == 0 && shin) regions[v] = BodyRegion::kBelowGarment;
    }
  }
  regions.resize(person_.body->num_vertices(), BodyRegion::kGarment);
  const Texture seen = extractor_->Merge();
  const MatrixX3d& dressed = person_.body->data().v_template;
  const WholeTexture whole = MakeWholeTexture(*person_.body, table, dressed, regions, seen);
  if (labels_.size() == person_.tracks.size()) {
    person_.labels = TexelLabels(*person_.body, table, dressed, regions, seen, labels_);
  }
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
  person_.report.behind = share(TexelSource::kBehind) + share(TexelSource::kMirroredBack);
  person_.report.hair = share(TexelSource::kHair);
  person_.report.limb_neighbour = share(TexelSource::kLimbNeighbour);
  person_.report.smooth_fill = share(TexelSource::kSmoothFill);
  extractor_.reset();
  return std::move(person_);
}

namespace {

constexpr size_t kFewest = 50;  ///< pixels needed for a median colour

bool IsTrunk(int part) { return part == 1 || part == 2; }
bool IsThigh(int part) { return part >= 7 && part <= 10; }
bool IsArmOrHand(int part) { return part == 3 || part == 4 || (part >= 15 && part <= 22); }

ChannelTriple ColourOf(const uint8_t* bgr) {
  return {static_cast<float>(bgr[0]), static_cast<float>(bgr[1]), static_cast<float>(bgr[2])};
}

float SquaredDistance(const ChannelTriple& a, const ChannelTriple& b) {
  float sum = 0;
  for (size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

}  // namespace

std::vector<uint8_t> WithoutLimbLeaks(const Image& image, std::span<const uint8_t> mask,
                                      std::span<const uint8_t> labels, std::span<const uint8_t> parts, int reach_px) {
  const size_t area = image.bgr.size() / 3;
  BODYLOOM_CHECK(mask.size() == area && labels.size() == area && parts.size() == area, "limb leaks: ", mask.size(),
                 " pixels of the mask, ", labels.size(), " labels and ", parts.size(), " parts of an image of ",
                 image.width, "x", image.height);
  cv::Mat off_arms(image.height, image.width, CV_8UC1), distance;
  for (size_t i = 0; i < area; ++i) off_arms.data[i] = IsArmOrHand(parts[i]) ? 0 : 255;
  cv::distanceTransform(off_arms, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const auto near_arm = [&](size_t i) { return distance.ptr<float>()[i] <= static_cast<float>(reach_px); };
  const auto label = [&](size_t i) { return static_cast<PersonLabel>(labels[i]); };
  std::vector<ChannelTriple> face_pixels, trunk_pixels, thigh_pixels;
  for (size_t i = 0; i < area; ++i) {
    if (mask[i] == 0) continue;
    const ChannelTriple bgr = ColourOf(&image.bgr[3 * i]);
    if (label(i) == PersonLabel::kFace) face_pixels.push_back(bgr);
    if (IsTrunk(parts[i]) && !near_arm(i)) trunk_pixels.push_back(bgr);
    if (IsThigh(parts[i]) && !near_arm(i)) thigh_pixels.push_back(bgr);
  }
  const std::optional<ChannelTriple> face = MedianColourOfMany(face_pixels, kFewest),
                                     trunk = MedianColourOfMany(trunk_pixels, kFewest),
                                     thigh = MedianColourOfMany(thigh_pixels, kFewest);
  std::vector<uint8_t> kept(mask.begin(), mask.end());
  for (size_t i = 0; i < area; ++i) {
    if (!(IsTrunk(parts[i]) || IsThigh(parts[i])) || !near_arm(i)) continue;
    const std::optional<ChannelTriple>& here = IsTrunk(parts[i]) ? trunk : thigh;
    const ChannelTriple bgr = ColourOf(&image.bgr[3 * i]);
    const bool like_skin = face && here && SquaredDistance(bgr, *face) < SquaredDistance(bgr, *here);
    if (like_skin || label(i) == PersonLabel::kSkin || label(i) == PersonLabel::kFace) kept[i] = 0;
  }
  return kept;
}

namespace {

constexpr size_t kLightSamples = 5000;

}  // namespace

PhotoLight LightOfPhoto(const Image& image, std::span<const uint8_t> labels, const LitSurface& surface) {
  BODYLOOM_CHECK(3 * labels.size() == image.bgr.size(), "light of a photo: ", labels.size(), " labels for ",
                 image.width, "x", image.height, " pixels");
  std::vector<int> person;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const int at = y * image.width + x;
      if (labels[at] != 0 && surface.NormalAt(x, y) != nullptr) person.push_back(at);
    }
  }
  const size_t count = std::min(person.size(), kLightSamples);
  MatrixX3d normals(static_cast<Eigen::Index>(count), 3);
  std::vector<double> light;
  std::vector<uint8_t> kinds;
  for (size_t k = 0; k < count; ++k) {
    const int at = person[k * person.size() / count], x = at % image.width, y = at / image.width;
    const float* n = surface.NormalAt(x, y);
    normals.row(static_cast<Eigen::Index>(k)) << n[0], n[1], n[2];
    const uint8_t* bgr = image.pixel(x, y);
    light.push_back(LuminanceOf({DecodePixel(bgr[2] / 255.0, PixelEncoding::kSrgb),
                                 DecodePixel(bgr[1] / 255.0, PixelEncoding::kSrgb),
                                 DecodePixel(bgr[0] / 255.0, PixelEncoding::kSrgb)}));
    kinds.push_back(labels[at]);
  }
  const FitLightingResult fit =
      FitLighting(normals, light, kinds, {.max_samples = static_cast<int>(kLightSamples), .ridge = kPhotoRidge});
  PhotoLight result;
  result.fit = fit.summary;
  if (fit.summary.IsUsable() && fit.summary.mean_shading > 0) {
    result.coefficients = fit.coefficients / fit.summary.mean_shading;
  }
  return result;
}

}  // namespace bodyloom
