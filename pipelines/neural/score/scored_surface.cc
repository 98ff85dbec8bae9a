// SPDX-License-Identifier: Apache-2.0
// The renderers that are a surface with colours: nothing was trained.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/observations.h"
#include "pipelines/neural/photo/people_data.h"
#include "pipelines/neural/score/scored_renderer.h"
#include "render/garment/fit_clothes.h"
#include "render/photo_avatar/draw_person.h"
#include "render/photo_avatar/photo_person.h"
#include "render/photo_avatar/photo_person_builder.h"
#include "render/texture/photo_frame.h"
#include "render/texture/planar_image.h"

namespace bodyloom {
namespace {

// Makes a person from a dataset's images, treated as photos with known fits (render/photo_avatar).

/// The frame as a photo that was fitted.
FittedPhoto FittedPhotoOf(const PhotoFrame& frame, const std::string& name, Track body) {
  FittedPhoto photo;
  photo.name = name;
  photo.image = ImageFromPlanes(frame.image, frame.size, frame.size);
  photo.track = std::move(body);
  photo.mask.width = photo.mask.height = frame.size;
  photo.mask.labels = photo.labels = frame.labels;
  return photo;
}

/// Makes person `person` of `people`; `photos` are its images `frames`. Empty when no photo shows enough of the person.
std::optional<PhotoPerson> PersonOfFrames(const PeopleData& people, int person, std::span<const int> frames,
                                          std::span<const PhotoFrame> photos, int texture_size,
                                          const FitClothesOptions& clothes) {
  PhotoPersonBuilder builder(people.body(), texture_size, nullptr, clothes);
  int used = 0;
  for (size_t k = 0; k < photos.size(); ++k) {
    Track body = people.BodyOf(person, frames[k]);
    if (!body.HasResult(0)) continue;
    const std::string name = Concatenate("person ", person, ", image ", frames[k]);
    try {
      builder.Add(FittedPhotoOf(photos[k], name, std::move(body)));
      ++used;
    } catch (const NoPersonFound&) {  // shows too little: the others may do
    }
  }
  if (used == 0) return std::nullopt;
  return builder.Finish();
}

/// Pose in frame `frame` with clothes at rest; empty where the frame's body is unknown.
std::optional<PersonPose> PoseOfFrame(const PhotoPerson& person, const PeopleData& people, int number, int frame) {
  const Track body = people.BodyOf(number, frame);
  if (!body.HasResult(0)) return std::nullopt;
  const Track moved = MovedByPerson(person, body);
  return PersonPose{StillVertices(person, moved), moved.CameraAt(0)};
}

constexpr int kMapSize = 256;  ///< texels of the maps of what photos show, as those of the profiles

PeopleDataRequest PeopleOf(const ScorePeopleRequest& request) {
  if (!request.run.empty()) throw RequestError("nothing was trained: not with a run");
  return {request.data, request.body, request.size, kMapSize, true, request.given};
}

class ScoredWarp : public ScoredRenderer {
 public:
  explicit ScoredWarp(const ScorePeopleRequest& request) : people_(PeopleOf(request)) {}

  [[nodiscard]] const PeopleData& people() const override { return people_; }
  double SetPhotos(int /*person*/, std::span<const int> /*frames*/, std::span<const PhotoFrame> photos) override {
    shown_ = MapsOf(photos, people_.source().texel_parts);
    return ShareFilled(shown_, photos.size());
  }
  RenderedPerson Render(int /*frame*/, const PhotoFrame& pose) override {
    RenderedPerson rendered = {pose.size, ShownOf(pose), {}, {}};
    for (const uint8_t part : pose.parts) rendered.alpha.push_back(part != 0 ? 1 : 0);
    return rendered;
  }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override { return LookUp(shown_, pose).image; }

 private:
  PeopleData people_;
  CoherentMaps shown_;
};

class ScoredPerson : public ScoredRenderer {
 public:
  explicit ScoredPerson(const ScorePeopleRequest& request)
      : people_(PeopleOf(request)), texture_size_(request.texture_size), threads_(ThreadsFor(request.threads)) {
    if (request.given.iuv) throw RequestError("--score-iuv: a body with a texture takes bodies, not IUV images");
  }

  [[nodiscard]] const PeopleData& people() const override { return people_; }
  double SetPhotos(int person, std::span<const int> frames, std::span<const PhotoFrame> photos) override {
    number_ = person;
    shown_ = MapsOf(photos, people_.source().texel_parts);
    FitClothesOptions clothes;
    clothes.num_threads = threads_;
    painter_.reset();
    person_ = PersonOfFrames(people_, person, frames, photos, texture_size_, clothes);
    if (person_) painter_.emplace(*person_, threads_);
    return ShareFilled(shown_, photos.size());
  }
  [[nodiscard]] bool HasPerson() const override { return person_.has_value(); }
  RenderedPerson Render(int frame, const PhotoFrame& pose) override {
    Image rendered(pose.size, pose.size);
    std::vector<uint8_t> coverage(static_cast<size_t>(pose.size) * pose.size, 0);
    if (person_) {
      if (const std::optional<PersonPose> body = PoseOfFrame(*person_, people_, number_, frame)) {
        painter_->Draw(body->vertices_in_camera, body->camera, &rendered, &coverage);
      }
    }
    return PersonImageOf(rendered, coverage);
  }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override { return LookUp(shown_, pose).image; }

 private:
  static RenderedPerson PersonImageOf(const Image& rendered, std::span<const uint8_t> coverage) {
    const size_t pixels = coverage.size();
    RenderedPerson result = {rendered.width, std::vector<float>(3 * pixels), {}, {}};
    for (size_t i = 0; i < pixels; ++i) {
      for (size_t c = 0; c < 3; ++c) result.image[c * pixels + i] = rendered.bgr[3 * i + 2 - c] / 255.0F;
      result.alpha.push_back(coverage[i] / 255.0F);
    }
    return result;
  }

  PeopleData people_;
  int texture_size_, threads_, number_ = 0;
  CoherentMaps shown_;
  std::optional<PhotoPerson> person_;
  std::optional<PersonPainter> painter_;
};

}  // namespace

std::unique_ptr<ScoredRenderer> MakeScoredWarp(const ScorePeopleRequest& request) {
  return std::make_unique<ScoredWarp>(request);
}
std::unique_ptr<ScoredRenderer> MakeScoredPerson(const ScorePeopleRequest& request) {
  return std::make_unique<ScoredPerson>(request);
}

}  // namespace bodyloom
