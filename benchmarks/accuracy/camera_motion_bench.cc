// SPDX-License-Identifier: Apache-2.0
/// bodyloom_bench_camera_motion: videos of cameras that stand, turned by known rotations, and what is found of them.
///
///   bodyloom_bench_camera_motion --clips FILE,… [--turns still,tremor-0.5,tremor-1.5,tremor-3,pan,zoom] [--seconds 10]
///                                [--focal PIXELS] [--known-focal 0] [--write FOLDER] [--measure 1] [--json F]
///
/// A clip is played forwards and backwards until `seconds` are full, and seen by a camera of the same size that turns:
/// pixels by H = K(t) R(t) K⁻¹, the picture mirrored beyond its borders, which is a scene at infinity like any other.
///   still        not turned; neither resampled
///   tremor-N     smooth drifts of N degrees about each axis, standard deviation, time constant 0.6 s
///   pan-N        N degrees to either side of the first direction in 4 s, with a tremor of 0.3 degrees; pan: 20
///   zoom         the focal length grows by 1.3 and back, with a tremor of 0.5 degrees
/// Rotations are those from the first frame, which is the original's.
/// --focal: of the clip, 0: the prior's mean. People are found by BlazePose in the turned frames and masked.
/// --write: the turned videos, and beside each the true path and the one found; --measure 0: the clip and its true path
/// alone.
/// moves: 0 unknown, 1 still, 2 turning, 3 moving. rms_deg: of the rotations found against the true ones, relative to
/// the first frame. focal_ratio: found over true. z: rms of the rotation's error over the stated σ. ms: processor time
/// a frame of following the background; solve_ms: of the solve of the whole clip.
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "data_tools/observations/load_camera_path.h"
#include "data_tools/synthesis/clips/smooth_curve.h"
#include "data_tools/video/video_reader.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"
#include "tracking/camera_motion/camera_motion.h"
#include "tracking/detection/background_tracker.h"
#include "tracking/detection/frame_detector.h"

namespace bodyloom {
namespace {

struct Turn {
  std::vector<Eigen::Matrix3d> rotation;  ///< camera from scene
  std::vector<double> zoom;               ///< focal length over the first
};

Turn TurnNamed(const std::string& name, const std::vector<double>& times, uint64_t seed) {
  double tremor = 0;
  if (name.starts_with("tremor-")) tremor = std::stod(name.substr(7));
  const bool pans = name.starts_with("pan");
  const double pan_deg = name.starts_with("pan-") ? std::stod(name.substr(4)) : 20;
  if (pans) tremor = 0.3;
  if (name == "zoom") tremor = 0.5;
  std::array<std::vector<double>, 3> drift;
  for (uint64_t k = 0; k < 3; ++k) drift[k] = SmoothDrift(times, 0.6, HashRandom(seed, {910, k}));
  Turn turn;
  for (size_t t = 0; t < times.size(); ++t) {
    Eigen::Vector3d w(drift[0][t], drift[1][t], drift[2][t]);
    w *= tremor * kDegree;
    const double swing = std::sin(2 * M_PI * times[t] / 4);
    if (pans) w.y() += pan_deg * kDegree * swing;
    turn.rotation.push_back(RotationFromAxisAngle(w));
    if (t > 0) turn.rotation[t] *= turn.rotation[0].transpose();
    turn.zoom.push_back(name == "zoom" ? 1 + 0.3 * (0.5 - 0.5 * std::cos(2 * M_PI * times[t] / 8)) : 1);
  }
  turn.rotation[0].setIdentity();
  return turn;
}

std::vector<Image> FramesOf(const std::string& clip, double seconds, double* fps) {
  VideoReader reader(clip);
  *fps = reader.info().fps;
  std::vector<Image> frames;
  Image frame;
  while (frames.size() < 1000 && reader.Read(&frame)) frames.push_back(frame);
  const auto wanted = static_cast<size_t>(seconds * *fps);
  if (frames.size() > wanted) frames.resize(wanted);
  return frames;
}

Image Turned(const Image& frame, const Eigen::Matrix3d& rotation, double focal, double zoom) {
  const double cx = 0.5 * (frame.width - 1), cy = 0.5 * (frame.height - 1);
  Eigen::Matrix3d from, to;
  from << focal, 0, cx, 0, focal, cy, 0, 0, 1;
  to << focal * zoom, 0, cx, 0, focal * zoom, cy, 0, 0, 1;
  const Eigen::Matrix3d map = from * rotation.transpose() * to.inverse();  // of the source, by the turned pixel
  Image turned(frame.width, frame.height);
  cv::Mat H(3, 3, CV_64F);
  for (int i = 0; i < 9; ++i) H.at<double>(i / 3, i % 3) = map(i / 3, i % 3);
  const cv::Mat source(frame.height, frame.width, CV_8UC3, const_cast<uint8_t*>(frame.bgr.data()));
  cv::Mat target(frame.height, frame.width, CV_8UC3, turned.bgr.data());
  cv::warpPerspective(source, target, H, target.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP,
                      cv::BORDER_REFLECT_101);
  return turned;
}

std::vector<CoveredRegion> RegionsOf(const std::vector<FramePerson>& people) {
  std::vector<CoveredRegion> regions;
  for (const FramePerson& person : people) {
    CoveredRegion& region = regions.emplace_back();
    const ImageRectangle box = VisibleRectangle(person.person);
    const double margin = 0.15 * std::max(box.x1 - box.x0, box.y1 - box.y0);
    region = {box.x0 - margin, box.y0 - margin, box.x1 + margin, box.y1 + margin, person.mask};
  }
  return regions;
}

/// Of this process: the machine may be busy with others.
double ProcessorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "Videos turned by known rotations";
  report.command = command;
  report.label_columns = {"clip", "turn"};
  report.value_columns = {"moves", "rms_deg", "focal_ratio", "focal_sigma", "z", "zoom", "ms", "solve_ms"};
  report.summarise = false;
  const bool measures = arguments.Integer("measure") != 0;
  for (const std::string& clip : arguments.List("clips")) {
    double fps = 30;
    const std::vector<Image> frames = FramesOf(clip, arguments.Integer("seconds"), &fps);
    const Image& first = frames.front();
    const double given = arguments.Integer("focal");
    const double focal = given > 0 ? given : StartFocalPx(first.width, first.height);
    const auto count = static_cast<size_t>(arguments.Integer("seconds") * fps);
    std::vector<double> times(count);
    for (size_t t = 0; t < count; ++t) times[t] = static_cast<double>(t) / fps;
    for (const std::string& name : arguments.List("turns")) {
      const Turn turn = TurnNamed(name, times, 5);
      FrameDetectorOptions detect;
      detect.blazepose.masks = true;
      const std::unique_ptr<FrameDetector> detector = MakeFrameDetector(detect);
      BackgroundTracker tracker;
      std::optional<VideoWriter> writer;
      const std::string stem = std::filesystem::path(clip).stem().string() + "_" + name;
      if (!arguments.Text("write").empty()) {
        std::filesystem::create_directories(arguments.Text("write"));
        writer.emplace(arguments.Text("write") + "/" + stem + ".mp4", first.width, first.height, fps);
      }
      double seconds = 0;
      for (size_t t = 0; t < count; ++t) {
        const size_t period = std::max<size_t>(1, 2 * frames.size() - 2), at = t % period;
        const Image& source = frames[at < frames.size() ? at : period - at];
        const Image frame = name == "still" ? source : Turned(source, turn.rotation[t], focal, turn.zoom[t]);
        if (writer) writer->Write(frame);
        if (!measures) continue;
        const std::vector<CoveredRegion> regions = RegionsOf(detector->Detect({&frame, 1}).front());
        const double before = ProcessorSeconds();
        tracker.Push(frame, times[t], regions);
        seconds += ProcessorSeconds() - before;
      }
      CameraPath truth;
      truth.timestamps = times;
      for (const Eigen::Matrix3d& rotation : turn.rotation) truth.poses.push_back({rotation, Eigen::Vector3d::Zero()});
      if (writer) {
        writer->Finish();
        WriteCameraPath(arguments.Text("write") + "/" + stem + ".json", truth);
      }
      if (!measures) continue;
      const BackgroundTracks tracks = tracker.Finish();
      const double before = ProcessorSeconds();
      CameraMotionOptions options;
      options.focal = FocalPrior::ForImage(first.width, first.height);
      if (arguments.Integer("known-focal") != 0) options.focal.log_mean = std::log(focal), options.focal_known = true;
      const CameraMotion motion = FindCameraMotion(tracks, options);
      const double solve_s = ProcessorSeconds() - before;
      double squares = 0, normal = 0;
      const size_t poses = motion.path.poses.size();
      for (size_t i = 0; i < poses; ++i) {
        const auto t = static_cast<size_t>(std::lround(motion.path.timestamps[i] * fps));
        const double off = RotationAngleBetween(turn.rotation[t], motion.path.poses[i].camera_from_world_rotation);
        squares += off * off;
        if (motion.sigma_rad[i] > 0) normal += off * off / (3 * motion.sigma_rad[i] * motion.sigma_rad[i]);
      }
      if (writer && motion.has_path())
        WriteCameraPath(arguments.Text("write") + "/" + stem + "_found.json", motion.path);
      const double n = static_cast<double>(poses);
      report.rows.push_back(
          {name,
           {std::filesystem::path(clip).filename().string(), name},
           {static_cast<double>(motion.kind), poses > 0 ? std::sqrt(squares / n) / kDegree : NAN,
            poses > 0 ? std::exp(motion.log_focal) / focal : NAN, motion.log_focal_sigma,
            poses > 0 ? std::sqrt(normal / n) : NAN, motion.zoom, 1e3 * seconds / double(count), 1e3 * solve_s}});
      std::fprintf(stderr, "%s %s: %s, %s; %zu anchors\n", clip.c_str(), name.c_str(), ToString(motion.kind).c_str(),
                   motion.why.c_str(), tracks.anchors.size());
    }
  }
  if (measures) HandOver(report, arguments.Text("json"));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_camera_motion", argc, argv,
                             {{"clips", ""},
                              {"turns", "still,tremor-0.5,tremor-1.5,tremor-3,pan,zoom"},
                              {"seconds", "10"},
                              {"focal", "0"},
                              {"known-focal", "0"},
                              {"write", ""},
                              {"measure", "1"},
                              {"json", ""}},
                             bodyloom::Run);
}
