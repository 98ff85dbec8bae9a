// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/animate_guided.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/neural/background.h"
#include "apps/neural/composite.h"
#include "apps/neural/guided_preview.h"
#include "apps/neural/guided_run.h"
#include "apps/neural/motion_preview.h"
#include "apps/neural/photo_input.h"
#include "apps/neural/score_guided.h"
#include "apps/neural/virtual_views.h"
#include "apps/progress.h"
#include "bodyloom/data_tools/datasets/person_set.h"
#include "bodyloom/data_tools/datasets/photo_segmentation.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/neural/guided/guided_renderer.h"
#include "bodyloom/neural/guided/train_guided.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::string run, image, image_track, image_labels, track, data, out, body, background = "photo", sheet, uv_maps, json,
                                                                             score;
  std::vector<std::string> views;
  std::vector<int> score_photos = {1};
  int image_frame = 0, score_frames = 8, threads = 0;
  std::string device = "cpu";
  bool as_seen = false, virtual_views = false, anywhere = false, full_size = false;
};

nlohmann::ordered_json ScoresJson(const GuidedScores& s) {
  return {{"frames", s.frames},
          {"image_l1", s.image_l1},
          {"psnr_db", s.psnr_db},
          {"silhouette_iou", s.silhouette_iou},
          {"label_iou", s.label_iou},
          {"lpips_stand_in", s.lpips},
          {"lpips_stand_in_deviation", s.lpips_deviation},
          {"contextual_stand_in", s.contextual}};
}

std::string ScoresText(const GuidedScores& s) {
  char line[256];
  std::snprintf(line, sizeof line,
                "L1 %.4f, PSNR %.2f dB, outline IoU %.3f, labels IoU %.3f, LPIPS %.4f (deviation %.4f), CS %.3f; LPIPS "
                "and CS by a stand-in",
                s.image_l1, s.psnr_db, s.silhouette_iou, s.label_iou, s.lpips, s.lpips_deviation, s.contextual);
  return line;
}

double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Scores on the test people of a set.
void RunScore(const Request& request, const GuidedRun& run, GuidedRenderer* renderer) {
  Image sheet;
  const std::vector<ScoredPhotos> scored =
      ScoreGuided({request.score, request.body, request.score_photos, request.score_frames}, run.config, renderer,
                  request.sheet.empty() ? nullptr : &sheet);
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const ScoredPhotos& s : scored) {
    std::printf("%d photo%s (%.0f %% of the texels): %s\n", s.photos, s.photos == 1 ? "" : "s", 100 * s.texels_seen,
                ScoresText(s.scores).c_str());
    nlohmann::ordered_json row = {{"photos", s.photos}, {"texels_seen", s.texels_seen}};
    row.update(ScoresJson(s.scores));
    json.push_back(row);
  }
  if (!request.sheet.empty()) WriteImage(request.sheet, sheet);
  if (!request.json.empty()) WriteFileAtomically(request.json, nlohmann::ordered_json{{"scores", json}}.dump(2) + "\n");
}

/// The poses to show, in the shape of the person in the photo.
Track TargetTrack(const Request& request, const Photo& photo) {
  Track track = request.data.empty() ? ReadTrack(request.track) : PersonSet(request.data).track();
  RequireBodyOf(photo, track, request.data.empty() ? request.track : request.data);
  track.motion.betas = photo.track.motion.betas;
  return track;
}

std::optional<MapCompletion> CompletionOf(const Request& request) {
  if (request.as_seen) return MapCompletion::kNone;
  if (request.virtual_views) return MapCompletion::kVirtualViews;
  return std::nullopt;
}

void Run(const Request& request) {
  const StageClock clock;
  if (request.score.empty() && (request.image.empty() || request.out.empty())) {
    throw RequestError("--image and --out are needed (or --score, to measure on a people set)");
  }
  if (request.score.empty() && request.track.empty() == request.data.empty()) {
    throw RequestError("one of --track and --data is needed");
  }
  RequireReadable(request.image, "image");
  RequireReadable(request.track, "track");
  RequireReadable(request.data, "data");
  RequireReadable(request.score, "people set");
  const PhotoBackground behind = ParsePhotoBackground(request.background);
  RequireReadable(behind.path, "background");
  for (const std::string& path : {request.out, request.sheet, request.uv_maps, request.json}) RequireWritable(path);
  RequireDistinct({request.image, request.track, request.image_track, behind.path},
                  {request.out, request.sheet, request.uv_maps, request.json});
  const GuidedRun run = ReadGuidedRun(request.run);
  const int size = run.config.profile.image_size, texture_size = run.config.profile.texture_size;
  const int threads = request.threads > 0 ? request.threads : static_cast<int>(std::thread::hardware_concurrency());
  GuidedRenderer renderer(CheckpointPath(request.run), run.config,
                          {request.anywhere ? 0 : run.reach, CompletionOf(request), threads, request.device});
  if (!request.score.empty()) {
    RunScore(request, run, &renderer);
    return;
  }

  PhotoRequest like;
  like.image = request.image;
  like.frame = request.image_frame;
  like.track = request.image_track;
  like.labels = request.image_labels;
  like.body = request.body;
  std::vector<PhotoRequest> requests = {like};
  for (const std::string& view : request.views) requests.push_back(ParsePhotoRequest(view, "--views", like));
  const std::vector<Photo> loaded = LoadPhotos(requests, size, texture_size);
  const Photo& photo = loaded.front();
  std::string notes;
  std::vector<PhotoFrame> photos;
  for (const Photo& one : loaded) {
    notes += one.notes;
    photos.push_back(one.frame);
  }
  const Track track = TargetTrack(request, photo);
  PhotoMapsOptions options;
  options.size = size;
  options.texture_size = texture_size;
  options.num_threads = threads;
  std::optional<PhotoMaps> maps;
  try {
    maps.emplace(*photo.body, track, options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error((request.data.empty() ? request.track : request.data) + ": " + error.what());
  }
  const std::vector<uint8_t> texel_parts = PartsOfTexels(*photo.body, *maps->texels());
  std::vector<PhotoFrame> virtual_views;
  if (renderer.completion() == MapCompletion::kVirtualViews) {
    virtual_views = VirtualViews(*photo.body, photo.track.motion.betas, size, texture_size);
  }
  const TexelNeighbours neighbours(texture_size, texel_parts, PlacesOfTexels(*photo.body, *maps->texels()));
  const double read_s = clock.total();
  try {
    renderer.SetSource(photos, {texel_parts, virtual_views, &neighbours});
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.image + ": " + error.what());
  }
  const double source_s = clock.total() - read_s;

  const PersonWindow& window = maps->window();
  const PictureSize pictures = SizeOfPictures(window, track.camera, request.full_size);
  std::optional<Background> background;
  if (behind.own) {
    notes += "background: the photo's, filled in where the person stood\n";
  } else {
    background.emplace(behind.path, pictures.width, pictures.height);
  }
  std::cout << notes << std::flush;
  const Image filled =
      background ? Image() : Covering(FilledBackground(photo.picture, photo.person), pictures.width, pictures.height);
  const double fps = track.num_frames() > 1
                         ? (track.num_frames() - 1) / (track.motion.timestamps.back() - track.motion.timestamps.front())
                         : 30;
  std::optional<PersonSet> truth;
  std::optional<GuidedScorer> scorer;
  if (!request.data.empty()) {
    truth.emplace(request.data);
    scorer.emplace(true);
  }
  VideoWriter video(request.out, pictures.width, pictures.height, fps);
  const std::vector<int> on_sheet = EvenlySpreadFrames(track.num_frames(), 6);
  std::vector<Image> sheet;
  std::vector<double> network_ms;
  double maps_s = 0, network_s = 0;
  int lost = 0;
  const double before_frames_s = clock.total();
  {
    Progress progress("animate");
    for (int t = 0; t < track.num_frames(); ++t) {
      ThrowIfInterrupted();
      Image composed = background ? background->Next() : filled;
      if (track.HasResult(t)) {
        const double start_s = clock.total();
        PhotoFrame frame;
        FillMaps(maps->At(t), size, texture_size, &frame);
        const double mapped_s = clock.total();
        const GuidedPicture picture = renderer.Render(frame);
        const double drawn_s = clock.total();
        maps_s += mapped_s - start_s;
        network_s += drawn_s - mapped_s;
        network_ms.push_back(1e3 * (drawn_s - mapped_s));
        Composite(picture.image, picture.alpha, window, t, &composed);
        if (truth) {
          const PersonFrame picture_of_truth = truth->Read(t, {true, false, false, false});
          FillPicture({CutWindow(picture_of_truth.rgb, window, t), CutLabels(picture_of_truth.labels, window, t)},
                      &frame);
          scorer->Add(picture, frame);
        }
        if (!request.sheet.empty() && std::binary_search(on_sheet.begin(), on_sheet.end(), t)) {
          sheet.push_back(PictureOf(photo.frame.image, size, size));
          sheet.push_back(PictureOf(LookUp(renderer.maps(), frame).image, size, size));
          sheet.push_back(LabelsPicture(picture.labels, size, size));
          sheet.push_back(PictureOf(picture.image, size, size));
          sheet.push_back(frame.image.empty() ? composed : PictureOf(frame.image, size, size));
        }
      } else {
        ++lost;
      }
      video.Write(composed);
      progress.Update("rendering", static_cast<double>(t + 1) / track.num_frames());
    }
    video.Finish();
  }
  const double frames_s = clock.total() - before_frames_s;
  if (!sheet.empty()) {
    ContactSheetOptions layout;
    layout.columns = 5;
    layout.cell_height_px = std::max(160, size);
    WriteImage(request.sheet, ContactSheet(sheet, layout));
  }
  if (!request.uv_maps.empty()) {
    WriteImage(request.uv_maps,
               GuidedMapsSheet(renderer.maps(), renderer.virtual_pictures(), static_cast<int>(photos.size())));
  }
  if (!request.json.empty()) {
    nlohmann::ordered_json json = {
        {"frames", track.num_frames()},
        {"frames_without_fit", lost},
        {"frames_kept", renderer.frames_kept()},
        {"photos", photos.size()},
        {"completion", ToText(renderer.completion())},
        {"window", size},
        {"picture", {pictures.width, pictures.height}},
        {"computed_share", renderer.computed_share()},
        {"network_ms_median", Median(network_ms)},
        {"notes", notes},
        {"seconds",
         {{"read", read_s}, {"source", source_s}, {"maps", maps_s}, {"networks", network_s}, {"frames", frames_s}}},
        {"output", request.out}};
    if (scorer) json["scores"] = ScoresJson(scorer->Scores());
    WriteFileAtomically(request.json, json.dump(2) + "\n");
  }
  std::printf(
      "%d frames, source encoded in %.1f s, networks %.0f ms a frame (%.0f %% of the window), %.1f frames/s in all\n",
      track.num_frames(), source_s, Median(network_ms), 100 * renderer.computed_share(),
      track.num_frames() / std::max(1e-9, frames_s));
  if (lost > 0) std::printf("%d frames have no fit and show the background\n", lost);
  if (renderer.frames_kept() > 0) {
    std::printf("%lld frames were those before and were not computed again\n",
                static_cast<long long>(renderer.frames_kept()));
  }
  if (scorer) std::printf("against %s: %s\n", request.data.c_str(), ScoresText(scorer->Scores()).c_str());
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace

void AddAnimateGuided(CLI::App& animate, std::function<void()>* action) {
  CLI::App* verb =
      animate.add_subcommand("animate", "Animates the person of a photo, as `bodyloom train animate` learned to");
  auto request = std::make_shared<Request>();
  verb->add_option("--run", request->run, "Folder of the trained run")->required();
  verb->add_option("--image", request->image, "The photo: a picture, a video, a folder of pictures, or a person set");
  verb->add_option("--image-track", request->image_track, "Its track, .npz (default: the person set's own)");
  verb->add_option("--image-frame", request->image_frame, "Frame of a video or set that is the photo")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--image-labels", request->image_labels, "DensePose's parts of the photo's clip (.npz)");
  verb->add_option("--views", request->views, "More pictures of the person, IMAGE:TRACK or IMAGE:TRACK:FRAME");
  verb->add_option("--track", request->track, "The motion: a track, .npz");
  verb->add_option("--data", request->data,
                   "Instead: a person set of the same person, whose motion is shown and whose pictures are compared");
  verb->add_option("--out", request->out, "The video, .mp4");
  verb->add_option("--body", request->body, "The tracks' body (default: the built-in body)");
  verb->add_option("--background", request->background, kPhotoBackgroundHelp)->capture_default_str();
  verb->add_flag("--as-seen", request->as_seen, "Leave empty what the photos do not show (the paper's -A)");
  verb->add_flag(
          "--virtual-views", request->virtual_views,
          "Complete the maps over six views drawn by the networks, as the paper does, instead of as the run says")
      ->excludes("--as-seen");
  verb->add_flag(
      "--anywhere", request->anywhere,
      "Compute the whole window: the person may be farther from the body than clothes ever were in training");
  verb->add_flag("--full-size", request->full_size, kFullSizeHelp);
  verb->add_option("--sheet", request->sheet, "Contact sheet: photo, what is known, labels, result");
  verb->add_option("--uv-maps", request->uv_maps, "Picture of the coherent maps and the virtual views");
  verb->add_option("--json", request->json, "Report with times");
  verb->add_option("--score", request->score, "Instead: measure on the test people of this people set");
  verb->add_option("--score-photos", request->score_photos, "Numbers of photos to measure with, such as 1 2 4")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_option("--score-frames", request->score_frames, "Pictures of each person to compare with")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::NonNegativeNumber);
  verb->add_option("--device", request->device, "Where the networks run")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
  verb->footer(
      "Example:\n"
      "  bodyloom animate animate --run run --image photo.jpg --image-track photo.npz --track dance.npz --out "
      "dance.mp4");
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
