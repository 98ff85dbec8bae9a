// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/animate_photo.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/neural/background.h"
#include "apps/neural/composite.h"
#include "apps/neural/motion_preview.h"
#include "apps/neural/photo_input.h"
#include "apps/neural/photo_run.h"
#include "apps/neural/view_angles.h"
#include "apps/progress.h"
#include "bodyloom/data_tools/datasets/label_of_part.h"
#include "bodyloom/data_tools/datasets/photo_segmentation.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/neural/photo/guess_texture.h"
#include "bodyloom/neural/photo/photo_renderer.h"
#include "bodyloom/neural/photo/train_photo.h"
#include "bodyloom/neural/training/made_ahead.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/render/contact_sheet.h"

namespace bodyloom {
namespace {

struct Request {
  std::string run, track, out, background = "photo", view_yaw, shape = "photo", sheet, texture, json, garment_from;
  std::vector<std::string> parts, views;
  PhotoRequest photo;
  int threads = 0;
  std::string device = "cpu";
  bool whole_window = false, full_size = false;
};

/// DensePose's parts of "top", "bottom", "shoes", "head", "arms" (below the elbow, with hands) or a number.
std::vector<int> PartsNamed(const std::vector<std::string>& names) {
  const std::pair<const char*, PersonLabel> groups[] = {{"top", PersonLabel::kTop},
                                                        {"bottom", PersonLabel::kBottom},
                                                        {"shoes", PersonLabel::kShoes},
                                                        {"head", PersonLabel::kFace},
                                                        {"arms", PersonLabel::kSkin}};
  std::vector<int> parts;
  for (const std::string& name : names) {
    const size_t before = parts.size();
    for (const auto& [group, label] : groups) {
      for (int part = 1; name == group && part < kPhotoParts; ++part) {
        if (LabelOfPart(part) == label) parts.push_back(part);
      }
    }
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && number >= 1 && number < kPhotoParts) {
      parts.push_back(number);
    }
    if (parts.size() == before) {
      throw RequestError("--parts " + name + ": expected top, bottom, shoes, head, arms or a DensePose part, 1 to 24");
    }
  }
  return parts;
}

/// The photo, more views of the same person, another one who lends a garment.
std::vector<PhotoRequest> PhotosOf(const Request& request) {
  std::vector<PhotoRequest> photos = {request.photo};
  for (const std::string& view : request.views) photos.push_back(ParsePhotoRequest(view, "--views", request.photo));
  if (!request.garment_from.empty()) {
    photos.push_back(ParsePhotoRequest(request.garment_from, "--garment-from", request.photo));
  }
  return photos;
}

/// What the person looks like. Adds to `notes` how much the other one shows of what is lent.
PartialTexture TextureOf(const Request& request, std::span<const Photo> photos, std::span<const uint8_t> texel_parts,
                         std::string* notes) {
  std::vector<PartialTexture> textures;
  for (const Photo& photo : photos) textures.push_back(PartialTextureOf(photo.frame));
  if (request.garment_from.empty()) return UnionOf(textures);
  const PartialTexture lent = std::move(textures.back());
  textures.pop_back();
  const std::vector<int> parts = PartsNamed(request.parts);
  std::vector<uint8_t> of_garment(texel_parts.begin(), texel_parts.end());
  for (uint8_t& part : of_garment) part = std::find(parts.begin(), parts.end(), int{part}) != parts.end() ? part : 0;
  const double share = VisibleShare(lent, of_garment);
  if (!(share > 0)) {
    throw std::runtime_error("--garment-from " + request.garment_from + ": nothing of --parts is to be seen there");
  }
  *notes += Concatenate(request.garment_from, ": shows ", std::lround(100 * share), " % of --parts\n");
  return WithParts(UnionOf(textures), lent, texel_parts, parts);
}

/// A median, 0 of nothing.
double Median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void Run(const Request& request) {
  StageClock clock;
  clock.Begin("prepare");
  if (request.parts.empty() != request.garment_from.empty()) {
    throw RequestError("--garment-from and --parts belong together");
  }
  const PhotoBackground choice = ParsePhotoBackground(request.background);
  RequireReadable(request.photo.image, "image");
  RequireReadable(request.photo.track, "track of the image");
  RequireReadable(request.photo.labels, "part labels");
  RequireReadable(request.track, "track");
  RequireReadable(choice.path, "background");
  RequireDistinct({request.track, request.photo.image, request.photo.track, request.photo.body, choice.path},
                  {request.out, request.sheet, request.texture, request.json});
  for (const std::string& path : {request.out, request.sheet, request.texture, request.json}) RequireWritable(path);
  const PhotoRun run = ReadPhotoRun(request.run);
  const PhotoProfile& profile = run.config.profile;
  const int S = profile.image_size, U = profile.texture_size;
  const int threads = request.threads > 0 ? request.threads : static_cast<int>(std::thread::hardware_concurrency());
  PartsNamed(request.parts);  // a wrong name is said before anything is read
  const std::vector<Photo> photos = LoadPhotos(PhotosOf(request), S, U);
  const Photo& photo = photos.front();
  Track track = ReadTrack(request.track);
  RequireBodyOf(photo, track, request.track);
  if (request.shape == "photo") track.motion.betas = photo.track.motion.betas;
  PhotoMapsOptions options;
  options.size = S;
  options.texture_size = U;
  options.yaw_deg = ViewAngles(request.view_yaw, track.num_frames(), 0, track.num_frames() - 1);
  std::unique_ptr<PhotoMaps> maps;
  try {
    maps = std::make_unique<PhotoMaps>(*photo.body, track, options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(request.track + ": " + error.what());
  }
  const PersonWindow& window = maps->window();
  const std::vector<uint8_t> texel_parts = PartsOfTexels(*photo.body, *maps->texels());
  std::string notes;
  for (const Photo& one : photos) notes += one.notes;
  PartialTexture texture = TextureOf(request, photos, texel_parts, &notes);
  const Image seen = PictureOf(texture.colour, U, U);
  if (run.config.GuessesUnseen()) {
    GuessTexture({U, texel_parts, PlacesOfTexels(*photo.body, *maps->texels())}, &texture);
  }
  std::cout << notes << std::flush;
  PhotoRenderer renderer(CheckpointPath(request.run), run.config,
                         {request.whole_window ? -1 : run.reach, threads, request.device});
  clock.Begin("encode the photo");
  renderer.Encode(texture);
  const std::vector<float> completed = renderer.CompletedTexture();
  if (!request.texture.empty()) WriteImage(request.texture, PictureOf(completed, U, U));
  clock.Begin("render");

  const PictureSize size = SizeOfPictures(window, track.camera, request.full_size);
  Background background(choice.path, size.width, size.height);
  Image behind;
  if (choice.own) behind = Covering(FilledBackground(photo.picture, photo.person), size.width, size.height);
  const int T = track.num_frames();
  const std::vector<double>& times = track.motion.timestamps;
  const double fps = T > 1 && times.back() > times.front() ? (T - 1) / (times.back() - times.front()) : 30;
  VideoWriter video(request.out, size.width, size.height, fps);
  const std::vector<int> on_sheet = EvenlySpreadFrames(T, 6);
  std::vector<Image> sheet = {PictureOf(photo.frame.image, S, S), seen, PictureOf(completed, U, U)};
  std::vector<double> network_ms;
  int lost = 0;
  {
    Progress progress("animate");
    // Maps of the next frames are made while the network is at work.
    MadeAhead<PhotoFrame> poses(T, [&](int64_t t) {
      PhotoFrame pose;
      if (track.HasResult(static_cast<int>(t))) FillMaps(maps->At(static_cast<int>(t)), S, U, &pose);
      return pose;
    });
    for (int t = 0; t < T; ++t) {
      ThrowIfInterrupted();
      const PhotoFrame pose = poses.Take();
      Image composed = choice.own ? behind : background.Next();
      if (pose.size > 0) {
        const StageClock one;
        const PhotoPicture picture = renderer.Render(pose);
        if (t > 0) network_ms.push_back(1e3 * one.total());  // the first frame warms up
        Composite(picture.image, picture.alpha, window, t, &composed);
      } else {
        ++lost;
      }
      video.Write(composed);
      if (std::binary_search(on_sheet.begin(), on_sheet.end(), t)) sheet.push_back(composed);
      progress.Update("rendering", static_cast<double>(t + 1) / T);
    }
    video.Finish();
  }
  clock.End();
  if (!request.sheet.empty()) {
    ContactSheetOptions layout;
    layout.columns = 3;
    layout.cell_height_px = S;
    WriteImage(request.sheet, ContactSheet(sheet, layout));
  }
  const double visible = VisibleShare(texture, texel_parts);
  const double render_s = clock.seconds().back().second, median_ms = Median(network_ms);
  if (!request.json.empty()) {
    nlohmann::ordered_json stages = nlohmann::ordered_json::object();
    for (const auto& [stage, stage_s] : clock.seconds()) stages[stage] = stage_s;
    const nlohmann::ordered_json json = {{"frames", T},
                                         {"frames_without_fit", lost},
                                         {"variant", ToText(run.config.variant)},
                                         {"texels_seen", visible},
                                         {"network_ms_median", median_ms},
                                         {"frames_per_second", T / std::max(1e-9, render_s)},
                                         {"picture", {size.width, size.height}},
                                         {"notes", notes},
                                         {"seconds", stages},
                                         {"output", request.out}};
    WriteFileAtomically(request.json, json.dump(2) + "\n");
  }
  std::printf("%d frames, %.0f %% of the texture seen, network %.0f ms a frame, %.1f frames/s rendered and written\n",
              T, 100 * visible, median_ms, T / std::max(1e-9, render_s));
  if (lost > 0) std::printf("%d frames have no fit and show the background\n", lost);
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace

void AddAnimatePhoto(CLI::App& animate, std::function<void()>* action) {
  CLI::App* verb = animate.add_subcommand("photo", "Renders a person from one photo, in any motion");
  auto request = std::make_shared<Request>();
  verb->add_option("--run", request->run, "Folder of a run of `bodyloom train photo`")->required();
  verb->add_option("--image", request->photo.image, "The photo: a picture, a video, a folder of pictures, a person set")
      ->required();
  verb->add_option("--image-track", request->photo.track, "Its track, .npz (default: the person set's own)");
  verb->add_option("--image-frame", request->photo.frame, "Which frame of image and track")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb->add_option("--image-labels", request->photo.labels,
                   "DensePose's parts of the photo, which give the outline (default: GrabCut)");
  verb->add_option("--track", request->track, "The motion: a track, .npz")->required();
  verb->add_option("--out", request->out, "The video, .mp4")->required();
  verb->add_option("--body", request->photo.body, "The tracks' body (default: the built-in body)");
  verb->add_option("--views", request->views,
                   "More pictures of the person, IMAGE:TRACK[:FRAME]: what they show is added");
  verb->add_option("--garment-from", request->garment_from, "Another person, IMAGE:TRACK[:FRAME], who lends --parts");
  verb->add_option("--parts", request->parts, "top, bottom, shoes, head, arms, or DensePose parts 1 to 24")
      ->delimiter(',');
  verb->add_option("--shape", request->shape, "Whose body shape moves: the photo's or the motion's")
      ->check(CLI::IsMember({"photo", "motion"}))
      ->capture_default_str();
  verb->add_option("--background", request->background, kPhotoBackgroundHelp)->capture_default_str();
  verb->add_option("--view-yaw", request->view_yaw,
                   "Turns the view about the person's vertical, degrees; FROM:TO turns it over the clip");
  verb->add_flag("--full-size", request->full_size, kFullSizeHelp);
  verb->add_flag("--whole-window", request->whole_window, "Compute the background of the window too");
  verb->add_option("--sheet", request->sheet, "Contact sheet: photo, its texture, the completed one, six frames");
  verb->add_option("--texture", request->texture, "The completed texture as an image");
  verb->add_option("--json", request->json, "Report with times");
  verb->add_option("--threads", request->threads, "0: all cores")->check(CLI::NonNegativeNumber);
  verb->add_option("--device", request->device, "Where the networks run")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
  verb->footer(
      "Example:\n"
      "  bodyloom animate photo --run run --image me.jpg --image-track me.npz --track dance.npz --out me.mp4\n"
      "      --garment-from you.jpg:you.npz --parts top,bottom");
  verb->callback([request, action] { *action = [request] { Run(*request); }; });
}

}  // namespace bodyloom
