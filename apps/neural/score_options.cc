// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/score_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <string>

#include "apps/neural/animate_options.h"
#include "geometry/base/callbacks.h"

namespace bodyloom {

void AddScoreOptions(CLI::App* verb, ScorePeopleRequest* request) {
  verb->add_option("--score", request->data,
                   "Instead: measure on the test people of this multi-person dataset; photos and images are the same "
                   "for `animate photo`, `guided` and `person`");
  verb->add_option("--score-photos", request->photos, "Numbers of photos to measure with, such as 1 2 4")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_option("--score-frames", request->frames, "Images of each person to compare with")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  verb->add_option_function<std::string>(
          "--score-labels",
          [request](const std::string& labels) { request->given.estimated_labels = labels == "estimated"; },
          "Of the photos: true, or estimated (GrabCut and the clothes parser, as of a photo without labels)")
      ->check(CLI::IsMember({"true", "estimated"}))
      ->default_str("true");
  verb->add_option("--score-tracks", request->given.track,
                   "Bodies: a track of this name in each clip's folder, of its frames (default: the true ones)")
      ->type_name("NAME");
  verb->add_flag("--score-iuv", request->given.iuv,
                 "What pixels show of the body is what the clips' IUV images say, in photos and poses");
  AddLikenessWeights(verb, &request->weights, "alexnet and lpips_alex for LPIPS, vgg19 for contextual scores");
}

bool IsScored(const ScorePeopleRequest& score, const PhotoAnimationRequest& animation) {
  if (score.data.empty()) {
    if (animation.photo.image.empty() || animation.out.empty()) {
      throw RequestError("--image and --out are needed (or --score, to measure on a multi-person dataset)");
    }
    if (!score.given.IsTrue()) throw RequestError("--score-labels, --score-tracks and --score-iuv belong to --score");
    return false;
  }
  if (animation.shape_of_motion || !animation.view_yaw.empty() || !animation.garment.from.empty()) {
    throw RequestError("--score measures people as they are: not with --shape, --view-yaw or --garment-from");
  }
  return true;
}

void TakeFrom(const PhotoAnimationRequest& animation, ScorePeopleRequest* score) {
  score->run = animation.run, score->body = animation.photo.body;
  score->sheet = animation.sheet, score->json = animation.json;
  score->threads = animation.threads, score->device = animation.device;
}

std::string ScoresText(const PersonScores& s) {
  const auto text = [](const char* format, auto... values) {
    char words[320];
    std::snprintf(words, sizeof words, format, values...);
    return std::string(words);
  };
  std::string line = text("L1 %.4f, PSNR %.2f dB, silhouette IoU %.3f", s.image_l1, s.psnr_db, s.silhouette_iou);
  if (!std::isnan(s.label_iou)) line += text(", labels IoU %.3f", s.label_iou);
  line += text(", LPIPS%s %.4f (deviation %.4f)", s.lpips_random_features ? " (random features)" : "", s.lpips,
               s.lpips_deviation);
  if (!std::isnan(s.contextual)) {
    line += text(", CS%s %.3f", s.contextual_random_features ? " (random features, a quarter of the channels)" : "",
                 s.contextual);
  }
  return line;
}

void Print(const ScorePeopleSummary& summary) {
  for (const ScoredPhotos& s : summary.scored) {
    std::printf("%d photo%s (%.0f %% of the texels; %s given): SSIM %.4f, %s\n", s.photos, s.photos == 1 ? "" : "s",
                100 * s.texels_seen, summary.given.c_str(), s.scores.ssim, ScoresText(s.scores).c_str());
    if (s.missing > 0) std::printf("  of %d people the photos show too little: drawn as nobody\n", s.missing);
  }
}

}  // namespace bodyloom
