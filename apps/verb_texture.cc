// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/track_video.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/video_reader.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/render/overlay.h"
#include "bodyloom/render/texture_extract.h"
#include "bodyloom/render/uv_fill.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "Each texel of the body's UV atlas looks for itself in the frames: where the camera sees it, its colour is taken, "
    "and\n"
    "the best nine views are merged. Texels that no frame shows stay black, or are filled with --fill. Frames without "
    "a\n"
    "fit, and those that were only interpolated, are left out.\n"
    "Examples:\n"
    "  bodyloom texture --track track.npz --video clip.mp4 --out texture.png --fill\n"
    "  bodyloom texture --track track.npz --video clip.mp4 --out texture.png --every 5 --confidence seen.png\n\n";

struct TextureCommand {
  std::string track, video, out, body, confidence, json;
  std::string merge = "median", fill_with = "pyramid";
  bool fill = false;
  int size = 512, every = 1, margin_px = -1;
  double trust = 0.1;
};

uint8_t Byte(float x) { return static_cast<uint8_t>(std::clamp(std::lround(255 * x), 0L, 255L)); }

Image ColourImage(const Texture& texture, const std::vector<float>& planes) {
  Image image(texture.width, texture.height);
  const size_t pixels = size_t(texture.width) * texture.height;
  for (size_t p = 0; p < pixels; ++p) {
    for (size_t c = 0; c < 3; ++c) image.bgr[3 * p + c] = Byte(planes[c * pixels + p]);
  }
  return image;
}

Image GreyImage(const Texture& texture, const std::vector<float>& plane) {
  std::vector<float> planes;
  for (int c = 0; c < 3; ++c) planes.insert(planes.end(), plane.begin(), plane.end());
  return ColourImage(texture, planes);
}

struct Gathered {
  int used = 0, passed_over = 0, beyond_video = 0;  ///< frames of the track
};

/// Pixels around outlines that are not used, when the user did not say: tracks are off by about a hundredth of the
/// person's height (of the joints, in the median frame).
int DefaultMargin(const Track& track) {
  std::vector<double> heights_px;
  for (int t = 0; t < static_cast<int>(track.joints.size()); ++t) {
    double low = 1e9, high = -1e9;
    Eigen::Vector2d pixel;
    for (Eigen::Index j = 0; j < track.joints[t].rows(); ++j) {
      if (!track.CameraAt(t).Project(track.joints[t].row(j).transpose(), &pixel)) continue;
      low = std::min(low, pixel.y());
      high = std::max(high, pixel.y());
    }
    if (high > low) heights_px.push_back(high - low);
  }
  if (heights_px.empty()) return 2;
  std::nth_element(heights_px.begin(), heights_px.begin() + heights_px.size() / 2, heights_px.end());
  return static_cast<int>(std::clamp(std::lround(0.01 * heights_px[heights_px.size() / 2]), 1L, 64L));
}

/// The video frame of the track's time zero. A video of just the track's frames, or one that is over before the track
/// begins, was cut to it: its first frame is the track's first, whatever the clock says.
int VideoOffset(const std::string& path, const Track& track) {
  const VideoInfo info = VideoReader(path).info();
  if (track.num_frames() == 0) return 0;
  const double fps = info.fps > 0 ? info.fps : VideoFrameRate(track.motion.timestamps);
  const int first = static_cast<int>(std::lround(track.motion.timestamps[0] * fps));
  const bool is_cut = info.num_frames > 0 && (info.num_frames == track.num_frames() || first >= info.num_frames);
  return is_cut ? -first : 0;
}

Gathered Gather(const TextureCommand& command, const BodyModel& body, const Track& track, TrackVideo* video,
                TextureExtractor* extractor) {
  Gathered gathered;
  Progress progress("texture");
  for (int t = 0; t < track.num_frames(); t += command.every) {
    ThrowIfInterrupted();
    progress.Update("gathering", double(t) / track.num_frames());
    const FrameStatus status = track.frame_status[t];
    const MatrixX3d vertices = TrackVertices(body, track, t);
    if (vertices.rows() == 0 || (status != FrameStatus::kTracked && status != FrameStatus::kWeak)) {
      ++gathered.passed_over;
      continue;
    }
    const Image* frame = video->At(track.motion.timestamps[t]);
    if (frame == nullptr) {
      ++gathered.beyond_video;
      continue;
    }
    extractor->Add(*frame, vertices, track.CameraAt(t), t);
    ++gathered.used;
  }
  return gathered;
}

void RunTexture(const TextureCommand& command) {
  StageClock clock;
  RequireReadable(command.track, "track");
  RequireReadable(command.video, "video");
  RequireReadable(command.body, "body model");
  RequireDistinct({command.track, command.video, command.body}, {command.out, command.confidence, command.json});
  for (const std::string& path : {command.out, command.confidence, command.json}) RequireWritable(path);
  const Track track_of_file = ReadTrack(command.track);
  if (track_of_file.camera.width == 0) {
    throw std::runtime_error(command.track + ": no image size, expected image_size so that the video can be matched");
  }
  TrackVideo video(command.video, track_of_file, NamedCamera().video_px_from_camera_px,
                   VideoOffset(command.video, track_of_file));
  const Track track = video.Moved(track_of_file);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  if (!body->has_uv()) {
    throw std::runtime_error(command.body +
                             ": a body without UV coordinates, expected vt and ft (bodyloom body convert "
                             "--uv adds them)");
  }
  if (track.motion.poses.cols() > 3 * body->num_joints()) {
    throw std::runtime_error(Concatenate(command.track, ": ", track.motion.poses.cols() / 3, " joints, the body '",
                                         body->name(), "' has ", body->num_joints(),
                                         "; give the track's own with --body"));
  }
  TextureExtractOptions options;
  options.texels.width = options.texels.height = command.size;
  options.edge_margin_px = command.margin_px >= 0 ? command.margin_px : DefaultMargin(track);
  if (command.merge == "mean") options.merge = TextureExtractOptions::Merge::kMean;
  clock.Begin("prepare");
  TextureExtractor extractor(*body, options);
  clock.Begin("gather");
  const Gathered gathered = Gather(command, *body, track, &video, &extractor);
  clock.Begin("merge");
  Texture texture = extractor.Merge();
  if (texture.num_seen == 0) {
    throw std::runtime_error(Concatenate(command.video, ": the body of ", command.track, " is seen in none of ",
                                         gathered.used, " frames, there is no texture"));
  }
  const UvTexelTable& table = extractor.table();
  clock.Begin("fill");
  std::vector<uint8_t> known(texture.confidence.size());
  for (size_t p = 0; p < known.size(); ++p) known[p] = texture.confidence[p] > (command.fill ? command.trust : 0);
  if (!command.fill) {
    FillGutter(*body, table, known, 3, texture.bgr);
  } else if (command.fill_with == "laplace") {
    LaplaceFill(*body, table, known).Fill(3, texture.bgr);
  } else {
    PyramidFill(*body, table).Fill(known, 3, texture.bgr);
  }
  clock.Begin("write");
  WriteImage(command.out, ColourImage(texture, texture.bgr));
  if (!command.confidence.empty()) WriteImage(command.confidence, GreyImage(texture, texture.confidence));
  clock.End();
  const double seen = double(texture.num_seen) / table.num_inside;
  if (!command.json.empty()) {
    nlohmann::ordered_json seconds = nlohmann::ordered_json::object();
    for (const auto& [stage, stage_seconds] : clock.seconds()) seconds[stage] = stage_seconds;
    const nlohmann::ordered_json json = {{"size", {texture.width, texture.height}},
                                         {"track_frames", track.num_frames()},
                                         {"frames_beyond_video", gathered.beyond_video},
                                         {"edge_margin_px", options.edge_margin_px},
                                         {"frames_used", gathered.used},
                                         {"frames_without_fit", gathered.passed_over},
                                         {"texels", table.num_inside},
                                         {"texels_seen", texture.num_seen},
                                         {"filled", command.fill},
                                         {"seconds", seconds}};
    WriteFileAtomically(command.json, json.dump(1) + "\n");
  }
  char line[160];
  std::snprintf(line, sizeof line, "%d frames show %.1f %% of the body%s\n", gathered.used, 100 * seen,
                command.fill ? ", the rest is filled" : "");
  std::cout << line;
  if (gathered.beyond_video > 0) {
    std::cout << "note     " << gathered.beyond_video << " frames of the track lie beyond the end of the video\n";
  }
  std::cout << "time     ";
  for (const auto& [stage, stage_seconds] : clock.seconds()) {
    std::snprintf(line, sizeof line, "%s %.2f, ", stage.c_str(), stage_seconds);
    std::cout << line;
  }
  std::snprintf(line, sizeof line, "in all %.2f s\n", clock.total());
  std::cout << line << "wrote    " << command.out << "\n";
}

}  // namespace

void AddTextureVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("texture", "Takes the tracked person's texture from the video");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<TextureCommand>();
  TextureCommand& c = *command;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--video", c.video, "the video, or a folder of images")->required()->type_name("PATH");
  verb->add_option("--out", c.out, "the texture, .png or .jpg")->required()->type_name("FILE");
  verb->add_option("--body", c.body, "the track's body (default: the built-in body)")->type_name("FILE");
  verb->add_option("--size", c.size, "texels a side")->capture_default_str()->check(CLI::Range(1, 8192));
  verb->add_option("--every", c.every, "look at every n-th frame")->capture_default_str()->check(CLI::PositiveNumber);
  verb->add_option("--merge", c.merge, "median or mean of the best views")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"median", "mean"}))
      ->type_name("KIND");
  verb->add_flag("--fill", c.fill, "fill what no frame shows, smoothly and across seams");
  verb->add_option("--fill-with", c.fill_with, "pyramid (fast) or laplace (smoothest)")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"pyramid", "laplace"}))
      ->type_name("KIND");
  verb->add_option("--trust", c.trust, "with --fill: texels seen worse than this (0 to 1) are filled, too")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--margin", c.margin_px,
                   "pixels around the body's outlines that are not used (default: 1 % of the person's height)")
      ->check(CLI::Range(0, 64));
  verb->add_option("--confidence", c.confidence, "how well each texel was seen, as a grey image")->type_name("FILE");
  verb->add_option("--json", c.json, "counts and times of the run")->type_name("FILE");
  verb->callback([command, action] { *action = [command] { RunTexture(*command); }; });
}

}  // namespace bodyloom
