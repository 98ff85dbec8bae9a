// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/score/score_people.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "neural/guided/choose_photos.h"
#include "pipelines/files.h"
#include "pipelines/neural/animation.h"
#include "pipelines/neural/person/person_renderer.h"
#include "pipelines/neural/score/scored_renderer.h"
#include "pipelines/neural/weights_folder.h"
#include "pipelines/report_json.h"
#include "render/texture/planar_image.h"
#include "render/view/contact_sheet.h"

namespace bodyloom {
namespace {

constexpr int kPairColumns = 4, kSmallestPairCell = 128;

/// Frame numbers of a person's photos and target images.
struct PersonPhotos {
  std::vector<int> photos, others;
};

PersonPhotos PhotosOf(const ScorePeopleRequest& request, const PhotoSource& truth, int person) {
  const int maximum = *std::max_element(request.photos.begin(), request.photos.end());
  PersonPhotos result;
  result.photos = ChoosePhotos(truth, person, maximum);
  for (int f = 0; f < truth.num_frames[person]; ++f) {
    if (std::find(result.photos.begin(), result.photos.end(), f) == result.photos.end()) result.others.push_back(f);
  }
  if (result.others.empty()) {
    throw std::runtime_error(request.data + ": a person has " + std::to_string(truth.num_frames[person]) +
                             " images, none is left to compare with");
  }
  return result;
}

nlohmann::ordered_json Report(const ScorePeopleSummary& summary) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ScoredPhotos& s : summary.scored) {
    nlohmann::ordered_json row = {
        {"photos", s.photos}, {"texels_seen", s.texels_seen}, {"people_missing", s.missing}, {"ssim", s.scores.ssim}};
    row.update(ToJson(s.scores));
    rows.push_back(row);
  }
  return {{"given", summary.given}, {"scores", rows}};
}

ScorePeopleSummary Score(const ScorePeopleRequest& request, ScoredRenderer* renderer,
                         const PipelineCallbacks& callbacks) {
  const PeopleData& people = renderer->people();
  const PhotoSource& source = people.source();
  std::unique_ptr<PeopleData> truth;
  if (!request.given.IsTrue()) {
    truth = std::make_unique<PeopleData>(
        PeopleDataRequest{request.data, request.body, source.size, source.texture_size, true, {}});
  }
  const int count = static_cast<int>(source.num_frames.size());
  std::vector<PersonScorer> scorers;
  ScorePeopleSummary summary;
  summary.given = ToText(request.given);
  std::vector<ScoredPhotos>& scored = summary.scored;
  const PersonScoring scoring = LikenessScoring(LikenessWeightsOf(ReadWeightsFolder(request.weights)), WindowSsim);
  for (const int photos : request.photos) {
    scorers.emplace_back(scoring);
    scored.emplace_back().photos = photos;
  }
  std::vector<Image> sheet;
  for (int person = 0; person < count; ++person) {
    const PersonPhotos chosen = PhotosOf(request, truth ? truth->source() : source, person);
    std::vector<PhotoFrame> photos;
    for (const int f : chosen.photos) photos.push_back(people.PhotoOf(person, f));
    for (size_t n = 0; n < scored.size(); ++n) {
      const size_t used = std::min(photos.size(), static_cast<size_t>(scored[n].photos));
      scored[n].texels_seen +=
          renderer->SetPhotos(person, std::span(chosen.photos).first(used), std::span(photos).first(used)) / count;
      scored[n].missing += renderer->HasPerson() ? 0 : 1;
      for (const int k : EvenlySpreadFrames(static_cast<int>(chosen.others.size()), request.frames)) {
        PhotoFrame other;
        source.fill(person, chosen.others[k], &other);
        const RenderedPerson rendered = renderer->Render(chosen.others[k], other);
        scorers[n].Add(rendered, other);
        if (request.sheet.empty() || n != 0 || k != 0) continue;
        const int size = other.size;
        for (const std::vector<float>& shown :
             {photos[0].image, renderer->ShownOf(other), rendered.image, other.image}) {
          sheet.push_back(ImageFromPlanes(shown, size, size));
        }
      }
      scorers[n].NextPerson();
      callbacks.Update("people", (person + (n + 1.0) / static_cast<double>(scored.size())) / count);
    }
  }
  for (size_t n = 0; n < scored.size(); ++n) scored[n].scores = scorers[n].Scores();
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

std::unique_ptr<ScoredRenderer> RendererOf(const ScorePeopleRequest& request) {
  switch (request.renderer) {
    case PeopleRenderer::kPhoto:
      return MakeScoredRun(request, PersonRendererKind::kPhoto);
    case PeopleRenderer::kGuided:
      return MakeScoredRun(request, PersonRendererKind::kGuided);
    case PeopleRenderer::kPerson:
      return MakeScoredPerson(request);
    case PeopleRenderer::kWarp:
      return MakeScoredWarp(request);
  }
  throw std::invalid_argument("score: no such renderer");
}

}  // namespace

ScorePeopleSummary ScorePeople(const ScorePeopleRequest& request, const PipelineCallbacks& callbacks) {
  CheckRequest(request);
  return Score(request, RendererOf(request).get(), callbacks);
}

}  // namespace bodyloom
