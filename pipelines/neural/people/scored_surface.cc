// SPDX-License-Identifier: Apache-2.0
// The renderers that are a surface with colours: nothing was trained.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/observations/nothing_to_track.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/neural/people/scored_renderer.h"
#include "bodyloom/pipelines/people/planar_picture.h"
#include "bodyloom/pipelines/person/draw_person.h"
#include "bodyloom/pipelines/person/person_cloth.h"
#include "bodyloom/pipelines/person/photo_person_builder.h"

namespace bodyloom {
namespace {

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
    shown_ = MapsOf(photos, people_.source());
    return ShareSeen(shown_, photos.size());
  }
  GuidedPicture Render(int /*frame*/, const PhotoFrame& pose) override {
    GuidedPicture picture = {pose.size, ShownOf(pose), {}, {}};
    for (const uint8_t part : pose.parts) picture.alpha.push_back(part != 0 ? 1 : 0);
    picture.labels = SomebodyOf(picture.alpha);
    return picture;
  }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override { return LookUp(shown_, pose).image; }

 private:
  PeopleData people_;
  CoherentMaps shown_;
};

/// The frame as a photo that was fitted.
FittedPhoto FittedPhotoOf(const PhotoFrame& frame, const std::string& name, Track body) {
  FittedPhoto photo;
  photo.name = name;
  photo.picture = PictureOf(frame.image, frame.size, frame.size);
  photo.track = std::move(body);
  photo.mask.width = photo.mask.height = frame.size;
  photo.mask.labels = frame.labels;
  return photo;
}

class ScoredPerson : public ScoredRenderer {
 public:
  explicit ScoredPerson(const ScorePeopleRequest& request)
      : people_(PeopleOf(request)), texture_size_(request.texture_size), threads_(ThreadsFor(request.threads)) {
    if (request.given.iuv) throw RequestError("--score-iuv: a body with a texture takes bodies, not IUV images");
  }

  [[nodiscard]] const PeopleData& people() const override { return people_; }
  double SetPhotos(int person, std::span<const int> frames, std::span<const PhotoFrame> photos) override {
    number_ = person;
    shown_ = MapsOf(photos, people_.source());
    FitClothesOptions clothes;
    clothes.num_threads = threads_;
    PhotoPersonBuilder builder(people_.body(), texture_size_, nullptr, clothes);
    int used = 0;
    for (size_t k = 0; k < photos.size(); ++k) {
      Track body = people_.BodyOf(person, frames[k]);
      if (!body.HasResult(0)) continue;
      const std::string name = Concatenate("person ", person, ", picture ", frames[k]);
      try {
        builder.Add(FittedPhotoOf(photos[k], name, std::move(body)));
        ++used;
      } catch (const NothingToTrack&) {  // shows too little: the others may do
      }
    }
    painter_.reset();
    if (used > 0) {
      person_ = builder.Finish();
      painter_.emplace(person_, threads_);
    }
    return ShareSeen(shown_, photos.size());
  }
  [[nodiscard]] bool HasPerson() const override { return painter_.has_value(); }
  GuidedPicture Render(int frame, const PhotoFrame& pose) override {
    const Track body = people_.BodyOf(number_, frame);
    Image picture(pose.size, pose.size);
    std::vector<uint8_t> coverage(static_cast<size_t>(pose.size) * pose.size, 0);
    if (painter_ && body.HasResult(0)) {
      const Track moved = MovedByPerson(person_, body);
      painter_->Draw(StillVertices(person_, moved), moved.CameraAt(0), &picture, &coverage);
    }
    return GuidedPictureOf(picture, coverage);
  }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override { return LookUp(shown_, pose).image; }

 private:
  static GuidedPicture GuidedPictureOf(const Image& picture, std::span<const uint8_t> coverage) {
    const size_t pixels = coverage.size();
    GuidedPicture result = {picture.width, std::vector<float>(3 * pixels), {}, {}};
    for (size_t i = 0; i < pixels; ++i) {
      for (size_t c = 0; c < 3; ++c) result.image[c * pixels + i] = picture.bgr[3 * i + 2 - c] / 255.0F;
      result.alpha.push_back(coverage[i] / 255.0F);
    }
    result.labels = SomebodyOf(result.alpha);
    return result;
  }

  PeopleData people_;
  int texture_size_, threads_, number_ = 0;
  CoherentMaps shown_;
  PhotoPerson person_;
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
