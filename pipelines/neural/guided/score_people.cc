// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/guided/score_people.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/neural/guided/choose_photos.h"
#include "bodyloom/neural/guided/guided_renderer.h"
#include "bodyloom/neural/photo/guess_texture.h"
#include "bodyloom/neural/photo/photo_renderer.h"
#include "bodyloom/neural/training/training_run.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/neural/animation.h"
#include "bodyloom/pipelines/neural/guided/guided_people.h"
#include "bodyloom/pipelines/neural/guided/guided_score_weights.h"
#include "bodyloom/pipelines/neural/guided/guided_scores_json.h"
#include "bodyloom/pipelines/people/planar_picture.h"
#include "bodyloom/pipelines/report_json.h"
#include "bodyloom/pipelines/runs/guided_run.h"
#include "bodyloom/pipelines/runs/photo_run.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kPairColumns = 4, kSmallestPairCell = 128;

/// A renderer to be scored.
class ScoredRenderer {
 public:
  ScoredRenderer() = default;
  ScoredRenderer(const ScoredRenderer&) = delete;
  ScoredRenderer& operator=(const ScoredRenderer&) = delete;
  virtual ~ScoredRenderer() = default;

  [[nodiscard]] virtual const GuidedPeople& people() const = 0;
  /// From now on this is the person. Returns the share of the atlas that the photos fill.
  virtual double SetPhotos(int person, std::span<const PhotoFrame> photos) = 0;
  virtual GuidedPicture Render(const PhotoFrame& pose) = 0;
  /// What the photos show of a pose, 3 planes.
  [[nodiscard]] virtual std::vector<float> ShownOf(const PhotoFrame& pose) const = 0;
};

/// As the maps have it: texels from the first `used` photos.
double ShareSeen(const CoherentMaps& maps, size_t used) {
  double filled = 0, atlas = 0;
  for (size_t i = 0; i < maps.from.size(); ++i) {
    atlas += maps.texel_parts[i] != 0 ? 1 : 0;
    filled += maps.from[i] != 0 && maps.from[i] <= used ? 1 : 0;
  }
  return filled / std::max(1.0, atlas);
}

PeopleDataRequest PeopleOf(const ScorePeopleRequest& request, int size, int texture_size) {
  return {request.data, request.body, size, texture_size, true, request.given};
}

class ScoredGuided : public ScoredRenderer {
 public:
  explicit ScoredGuided(const ScorePeopleRequest& request) : ScoredGuided(request, ReadGuidedRun(request.run)) {}

  [[nodiscard]] const GuidedPeople& people() const override { return people_; }
  double SetPhotos(int person, std::span<const PhotoFrame> photos) override {
    std::vector<PhotoFrame> views;
    if (renderer_.completion() == MapCompletion::kVirtualViews) views = people_.VirtualViewsOf(person);
    renderer_.SetSource(photos, {people_.source().texel_parts, views, &neighbours_});
    return ShareSeen(renderer_.maps(), photos.size());
  }
  GuidedPicture Render(const PhotoFrame& pose) override { return renderer_.Render(pose); }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override {
    return LookUp(renderer_.maps(), pose).image;
  }

 private:
  ScoredGuided(const ScorePeopleRequest& request, const GuidedRun& run)
      : renderer_(CheckpointPath(request.run), run.config,
                  {request.anywhere ? 0 : run.reach, request.completion, ThreadsFor(request.threads), request.device}),
        people_(PeopleOf(request, run.config.profile.image_size, run.config.profile.texture_size)),
        neighbours_(people_.source().texture_size, people_.source().texel_parts, people_.source().texel_places) {}

  GuidedRenderer renderer_;
  GuidedPeople people_;
  TexelNeighbours neighbours_;
};

class ScoredPhoto : public ScoredRenderer {
 public:
  explicit ScoredPhoto(const ScorePeopleRequest& request) : ScoredPhoto(request, ReadPhotoRun(request.run)) {}

  [[nodiscard]] const GuidedPeople& people() const override { return people_; }
  double SetPhotos(int /*person*/, std::span<const PhotoFrame> photos) override {
    std::vector<PartialTexture> textures;
    for (const PhotoFrame& photo : photos) textures.push_back(PartialTextureOf(photo));
    PartialTexture texture = UnionOf(textures);
    const double share = VisibleShare(texture, people_.source().texel_parts);
    shown_ = EmptyMaps(texture.size, people_.source().texel_parts);
    for (size_t k = 0; k < photos.size(); ++k) {
      FillEmptyTexels(photos[k], OwnPicture(photos[k]), static_cast<uint8_t>(k + 1), {}, &shown_);
    }
    if (guesses_) GuessTexture(neighbours_, &texture);
    renderer_.Encode(texture);
    return share;
  }
  GuidedPicture Render(const PhotoFrame& pose) override {
    PhotoPicture drawn = renderer_.Render(pose);
    GuidedPicture picture = {drawn.size, std::move(drawn.image), std::move(drawn.alpha), {}};
    // It draws no labels: somebody, whatever is worn, or nobody.
    for (const float alpha : picture.alpha) picture.labels.push_back(alpha >= 0.5F ? 1 : 0);
    return picture;
  }
  [[nodiscard]] std::vector<float> ShownOf(const PhotoFrame& pose) const override { return LookUp(shown_, pose).image; }

 private:
  ScoredPhoto(const ScorePeopleRequest& request, const PhotoRun& run)
      : guesses_(run.config.GuessesUnseen()),
        renderer_(CheckpointPath(request.run), run.config,
                  {request.anywhere ? -1 : run.reach, ThreadsFor(request.threads), request.device}),
        people_(PeopleOf(request, run.config.profile.image_size, run.config.profile.texture_size)),
        neighbours_(people_.source().texture_size, people_.source().texel_parts, people_.source().texel_places) {}

  bool guesses_;
  PhotoRenderer renderer_;
  GuidedPeople people_;
  TexelNeighbours neighbours_;
  CoherentMaps shown_;
};

/// Numbers of a person's photos, and of the pictures to compare with.
struct PersonPhotos {
  std::vector<int> photos, others;
};

PersonPhotos PhotosOf(const ScorePeopleRequest& request, const PhotoSource& truth, int person) {
  const int most = *std::max_element(request.photos.begin(), request.photos.end());
  PersonPhotos result;
  result.photos = ChoosePhotos(truth, person, most);
  for (int f = 0; f < truth.num_frames[person]; ++f) {
    if (std::find(result.photos.begin(), result.photos.end(), f) == result.photos.end()) result.others.push_back(f);
  }
  if (result.others.empty()) {
    throw std::runtime_error(request.data + ": a person has " + std::to_string(truth.num_frames[person]) +
                             " pictures, none is left to compare with");
  }
  return result;
}

nlohmann::ordered_json Report(const ScorePeopleSummary& summary) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ScoredPhotos& s : summary.scored) {
    nlohmann::ordered_json row = {{"photos", s.photos}, {"texels_seen", s.texels_seen}};
    row.update(ToJson(s.scores));
    rows.push_back(row);
  }
  return {{"given", summary.given}, {"scores", rows}};
}

ScorePeopleSummary Score(const ScorePeopleRequest& request, bool has_labels, ScoredRenderer* renderer,
                         const PipelineCallbacks& callbacks) {
  const GuidedPeople& people = renderer->people();
  const PhotoSource& source = people.source();
  std::unique_ptr<PeopleData> truth;
  if (!request.given.IsTrue()) {
    truth = std::make_unique<PeopleData>(
        PeopleDataRequest{request.data, request.body, source.size, source.texture_size, true, {}});
  }
  const int count = static_cast<int>(source.num_frames.size());
  std::vector<std::unique_ptr<GuidedScorer>> scorers;
  ScorePeopleSummary summary;
  summary.given = ToText(request.given);
  std::vector<ScoredPhotos>& scored = summary.scored;
  const GuidedScoreWeights weights = GuidedScoreWeightsOf(ReadWeightsFolder(request.weights));
  for (const int photos : request.photos) {
    scorers.push_back(std::make_unique<GuidedScorer>(true, weights));
    scored.push_back({photos, {}, 0});
  }
  std::vector<Image> sheet;
  for (int person = 0; person < count; ++person) {
    const PersonPhotos chosen = PhotosOf(request, truth ? truth->source() : source, person);
    std::vector<PhotoFrame> photos;
    for (const int f : chosen.photos) photos.push_back(people.PhotoOf(person, f));
    for (size_t n = 0; n < scored.size(); ++n) {
      const size_t used = std::min(photos.size(), static_cast<size_t>(scored[n].photos));
      scored[n].texels_seen += renderer->SetPhotos(person, std::span(photos).first(used)) / count;
      for (const int k : EvenlySpreadFrames(static_cast<int>(chosen.others.size()), request.frames)) {
        PhotoFrame other;
        source.fill(person, chosen.others[k], &other);
        const GuidedPicture picture = renderer->Render(other);
        scorers[n]->Add(picture, other);
        if (request.sheet.empty() || n != 0 || k != 0) continue;
        const int size = other.size;
        for (const std::vector<float>& shown :
             {photos[0].image, renderer->ShownOf(other), picture.image, other.image}) {
          sheet.push_back(PictureOf(shown, size, size));
        }
      }
      scorers[n]->NextPerson();
      callbacks.Update("people", (person + (n + 1.0) / static_cast<double>(scored.size())) / count);
    }
  }
  for (size_t n = 0; n < scored.size(); ++n) {
    scored[n].scores = scorers[n]->Scores();
    if (!has_labels) scored[n].scores.label_iou = std::numeric_limits<double>::quiet_NaN();
  }
  WriteSheet(request.sheet, sheet, kPairColumns, std::max(kSmallestPairCell, source.size));
  WriteReport(request.json, Report(summary));
  summary.written = FilesAmong({request.sheet, request.json});
  return summary;
}

void CheckRequest(const ScorePeopleRequest& request) {
  BODYLOOM_CHECK(!request.photos.empty(), "score: no number of photos given");
  RequireReadable(request.data, "multi-person dataset");
  RequireOutputs({}, {request.sheet, request.json});
}

}  // namespace

ScorePeopleSummary ScoreGuided(const ScorePeopleRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  ScoredGuided renderer(request);
  return Score(request, true, &renderer, callbacks);
}

ScorePeopleSummary ScorePhoto(const ScorePeopleRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  ScoredPhoto renderer(request);
  return Score(request, false, &renderer, callbacks);
}

}  // namespace bodyloom
