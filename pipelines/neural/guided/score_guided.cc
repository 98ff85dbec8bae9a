// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/guided/score_guided.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/neural/guided/choose_photos.h"
#include "bodyloom/neural/guided/guided_renderer.h"
#include "bodyloom/neural/training/training_run.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/pipelines/neural/animation.h"
#include "bodyloom/pipelines/neural/guided/guided_people.h"
#include "bodyloom/pipelines/neural/guided/guided_score_weights.h"
#include "bodyloom/pipelines/neural/guided/guided_scores_json.h"
#include "bodyloom/pipelines/people/planar_picture.h"
#include "bodyloom/pipelines/report_json.h"
#include "bodyloom/pipelines/runs/guided_run.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kPairColumns = 4, kSmallestPairCell = 128;

/// A person's photos, and the pictures to compare with.
struct PersonPhotos {
  std::vector<PhotoFrame> photos;
  std::vector<int> others;  ///< numbers of the person's other pictures
};

PersonPhotos PhotosOf(const ScoreGuidedRequest& request, const PhotoSource& source, int person) {
  const int most = *std::max_element(request.photos.begin(), request.photos.end());
  const std::vector<int> chosen = ChoosePhotos(source, person, most);
  PersonPhotos result;
  for (int f = 0; f < source.num_frames[person]; ++f) {
    if (std::find(chosen.begin(), chosen.end(), f) == chosen.end()) result.others.push_back(f);
  }
  if (result.others.empty()) {
    throw std::runtime_error(request.data + ": a person has " + std::to_string(source.num_frames[person]) +
                             " pictures, none is left to compare with");
  }
  result.photos.resize(chosen.size());
  for (size_t i = 0; i < chosen.size(); ++i) source.fill(person, chosen[i], &result.photos[i]);
  return result;
}

/// Share of the atlas' texels that the first `used` photos fill.
double ShareSeen(const CoherentMaps& maps, size_t used) {
  double filled = 0, atlas = 0;
  for (size_t i = 0; i < maps.from.size(); ++i) {
    atlas += maps.texel_parts[i] != 0 ? 1 : 0;
    filled += maps.from[i] != 0 && maps.from[i] <= used ? 1 : 0;
  }
  return filled / std::max(1.0, atlas);
}

nlohmann::ordered_json Report(const std::vector<ScoredPhotos>& scored) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ScoredPhotos& s : scored) {
    nlohmann::ordered_json row = {{"photos", s.photos}, {"texels_seen", s.texels_seen}};
    row.update(ToJson(s.scores));
    rows.push_back(row);
  }
  nlohmann::ordered_json report = nlohmann::ordered_json::object();
  report["given"] = kGivenOfPeople;
  report["scores"] = rows;
  return report;
}

}  // namespace

ScoreGuidedSummary ScoreGuided(const ScoreGuidedRequest& request, const PipelineCallbacks& callbacks) {
  BODYLOOM_CHECK(!request.photos.empty(), "score: no number of photos given");
  RequireReadable(request.data, "multi-person dataset");
  RequireOutputs({}, {request.sheet, request.json});
  const GuidedRun run = ReadGuidedRun(request.run);
  GuidedRenderer renderer(
      CheckpointPath(request.run), run.config,
      {request.anywhere ? 0 : run.reach, request.completion, ThreadsFor(request.threads), request.device});
  const GuidedPeople people(
      {request.data, request.body, run.config.profile.image_size, run.config.profile.texture_size, true});
  const PhotoSource& source = people.source();
  const int count = static_cast<int>(source.num_frames.size());
  const TexelNeighbours neighbours(source.texture_size, source.texel_parts, source.texel_places);
  std::vector<std::unique_ptr<GuidedScorer>> scorers;
  ScoreGuidedSummary summary;
  std::vector<ScoredPhotos>& scored = summary.scored;
  const GuidedScoreWeights weights = GuidedScoreWeightsOf(ReadWeightsFolder(request.weights));
  for (const int photos : request.photos) {
    scorers.push_back(std::make_unique<GuidedScorer>(true, weights));
    scored.push_back({photos, {}, 0});
  }
  std::vector<Image> sheet;
  for (int person = 0; person < count; ++person) {
    const PersonPhotos of_person = PhotosOf(request, source, person);
    const std::vector<PhotoFrame>& photos = of_person.photos;
    std::vector<PhotoFrame> views;
    if (renderer.completion() == MapCompletion::kVirtualViews) views = people.VirtualViewsOf(person);
    for (size_t n = 0; n < scored.size(); ++n) {
      const size_t used = std::min(photos.size(), static_cast<size_t>(scored[n].photos));
      renderer.SetSource(std::span(photos).first(used), {source.texel_parts, views, &neighbours});
      const CoherentMaps& maps = renderer.maps();
      scored[n].texels_seen += ShareSeen(maps, used) / count;
      for (const int k : EvenlySpreadFrames(static_cast<int>(of_person.others.size()), request.frames)) {
        PhotoFrame truth;
        source.fill(person, of_person.others[k], &truth);
        const GuidedPicture picture = renderer.Render(truth);
        scorers[n]->Add(picture, truth);
        if (request.sheet.empty() || n != 0 || k != 0) continue;
        const int size = truth.size;
        sheet.push_back(PictureOf(photos[0].image, size, size));
        sheet.push_back(PictureOf(LookUp(maps, truth).image, size, size));
        sheet.push_back(PictureOf(picture.image, size, size));
        sheet.push_back(PictureOf(truth.image, size, size));
      }
      scorers[n]->NextPerson();
      callbacks.Update("people", (person + (n + 1.0) / static_cast<double>(scored.size())) / count);
    }
  }
  for (size_t n = 0; n < scored.size(); ++n) scored[n].scores = scorers[n]->Scores();
  WriteSheet(request.sheet, sheet, kPairColumns, std::max(kSmallestPairCell, run.config.profile.image_size));
  WriteReport(request.json, Report(scored));
  summary.written = FilesAmong({request.sheet, request.json});
  return summary;
}

}  // namespace bodyloom
