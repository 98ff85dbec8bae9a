// SPDX-License-Identifier: Apache-2.0
/// Training windows per second with one and two threads, and time by stage.
///
///   bodyloom_bench_lifter_windows [--motion FOLDER] [--windows 4000] [--json F] [--picture F.png] [--first 0]
///                                 [--floor_poses F.png] [--floor_share 0..1]
///
/// Motion: the demo motion, or the training motion of the library in FOLDER. --picture draws six windows from seed
/// --first: detections above, their landmarks from the front and from the side below, upright by the target's vertical.
/// --floor_poses draws three people for each way of being on the floor.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/motion_library.h"
#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/lifter/lifter_windows.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "render/view/overlay_landmarks.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3f;

const double kNone = std::numeric_limits<double>::quiet_NaN();

struct Library {
  std::vector<Motion> motions;
  std::vector<char> has_floor;
};

Library Motions(const std::string& folder) {
  if (folder.empty()) return {{DemoMotion(BuiltinBody(), 360, 60)}, {1}};
  Library library;
  MotionLibraryOptions options;
  options.visit_test = false;
  for (LibraryClip& clip : LoadMotionLibrary({folder}, options)) {
    if (clip.motion.num_frames() < 2) continue;
    library.has_floor.push_back(clip.has_floor ? 1 : 0);
    library.motions.push_back(std::move(clip.motion));
  }
  return library;
}

/// Draws 21 points, given as positions (x right, y down, units of the body), in a box of the image.
void DrawPerson(const std::vector<Vector2d>& points, const std::vector<float>& confidence, const Vector2d& corner_px,
                double size_px, Image* image) {
  DrawnKeypoints drawn;
  drawn.names = LifterPointNames();
  drawn.pixels.resize(kLifterPoints, 2);
  for (int k = 0; k < kLifterPoints; ++k) {
    drawn.pixels.row(k) = (corner_px + Vector2d(0.5, 0.5) * size_px + points[k] * size_px / 2.3).transpose();
    if (confidence[k] <= 0) drawn.pixels.row(k).setConstant(kNone);
  }
  DrawKeypoints(drawn, {2.5, true, false, 1}, image);
}

/// Positions upright by `up`, seen along the camera's depth or across it.
std::vector<Vector2d> Upright(const float* points, const Vector3f& up, bool from_the_side) {
  const Vector3f right = up.cross(Vector3f::UnitZ()).normalized() * -1, depth = right.cross(up);
  std::vector<Vector2d> result;
  for (int k = 0; k < kLifterPoints; ++k) {
    const Vector3f p(points[3 * k], points[3 * k + 1], points[3 * k + 2]);
    result.emplace_back(p.dot(from_the_side ? depth : right), -p.dot(up));
  }
  return result;
}

void DrawWindows(const LifterWindowGenerator& generator, uint64_t first, const std::string& path) {
  constexpr int kWindows = 6, kMoments = 9;
  constexpr double kSize = 150;
  Image image(static_cast<int>(kMoments * kSize), static_cast<int>(3 * kWindows * kSize), {250, 250, 250});
  const std::vector<float> all(kLifterPoints, 1);
  for (int w = 0; w < kWindows; ++w) {
    LifterWindow window;
    generator.Generate(first + static_cast<uint64_t>(w), &window);
    const int T = generator.options().num_frames;
    for (int m = 0; m < kMoments; ++m) {
      const size_t t = static_cast<size_t>(m) * (T - 1) / (kMoments - 1);
      std::vector<Vector2d> seen;
      seen.reserve(kLifterPoints);
      const float* f = &window.features[t * kLifterInputs];
      for (int k = 0; k < kLifterPoints; ++k) seen.emplace_back(f[3 * k], f[3 * k + 1]);
      const std::vector<float> confidence(&window.confidence[t * kLifterPoints],
                                          &window.confidence[t * kLifterPoints] + kLifterPoints);
      const Vector3f up(&window.up[3 * t]);
      const float* points = &window.points[3 * t * kLifterPoints];
      DrawPerson(seen, confidence, Vector2d(m, 3 * w) * kSize, kSize, &image);
      DrawPerson(Upright(points, up, false), all, Vector2d(m, 3 * w + 1) * kSize, kSize, &image);
      DrawPerson(Upright(points, up, true), all, Vector2d(m, 3 * w + 2) * kSize, kSize, &image);
    }
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) image.pixel(x, static_cast<int>(3 * w * kSize))[c] = 120;
    }
  }
  WriteImage(path, image);
}

void DrawFloorPoses(const LifterBody& body, const std::string& path) {
  constexpr double kSize = 150;
  constexpr int kPeople = 6, kColumns = 2;
  const int rows = (NumFloorPoses() + kColumns - 1) / kColumns;
  Image image(static_cast<int>(kColumns * kPeople * kSize), static_cast<int>(rows * kSize), {250, 250, 250});
  const std::vector<float> all(kLifterPoints, 1);
  for (int kind = 0; kind < NumFloorPoses(); ++kind) {
    const int row = kind / kColumns, column = kind % kColumns;
    std::printf("row %d, column %d: %s\n", row, column, FloorPoseName(kind));
    for (int i = 0; i < kPeople / 2; ++i) {
      HashRandom random(static_cast<uint64_t>(i), {static_cast<uint64_t>(kind)});
      const LifterPerson person = body.Person({});
      const auto pose = RandomFloorPose(kind, body, person, &random);
      PosedPerson posed;
      body.Pose(person, pose.data(), Vector3f::Zero(), &posed);
      const float floor = body.Lowest(person, posed);
      for (int view = 0; view < 2; ++view) {
        std::vector<Vector2d> points;
        const Vector3f middle = 0.5F * (posed.point[kLifterLeftHip] + posed.point[kLifterLeftShoulder]);
        for (const Vector3f& p : posed.point) {
          points.emplace_back((view == 0 ? p.z() - middle.z() : p.x() - middle.x()) / 1.3, 0.8 - (p.y() - floor) / 1.3);
        }
        DrawPerson(points, all, Vector2d(column * kPeople + 2 * i + view, row) * kSize, kSize, &image);
      }
    }
    const int y = static_cast<int>((row + 0.5 + 0.8 / 2.3) * kSize);
    for (int x = 0; x < image.width; ++x) {
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = 170;
    }
  }
  WriteImage(path, image);
}

struct Times {
  double processor_us, wall_us;
};

/// A window, best of three rounds; processor time is that of the calling thread.
Times Measure(int windows, const std::function<void()>& work) {
  const auto processor = [] {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  Times best{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int round = 0; round < 3; ++round) {
    const Stopwatch watch;
    const double processor_start = processor();
    work();
    best.processor_us = std::min(best.processor_us, (processor() - processor_start) * 1e6 / windows);
    best.wall_us = std::min(best.wall_us, watch.seconds() * 1e6 / windows);
  }
  return best;
}

void Run(const BenchArguments& arguments, const std::string& command) {
  const Library library = Motions(arguments.Text("motion"));
  LifterWindowOptions options;
  if (!arguments.Text("floor_share").empty()) options.floor_poses = std::stod(arguments.Text("floor_share"));
  double seconds = 0;
  for (const Motion& m : library.motions) seconds += m.timestamps.back() - m.timestamps.front();
  const LifterWindowGenerator generator(library.motions, library.has_floor, BuiltinBody(), options);
  std::printf("%zu motions, %.0f s\n", library.motions.size(), seconds);
  if (!arguments.Text("picture").empty())
    DrawWindows(generator, static_cast<uint64_t>(arguments.Integer("first")), arguments.Text("picture"));
  if (!arguments.Text("floor_poses").empty()) DrawFloorPoses(generator.body(), arguments.Text("floor_poses"));

  const int windows = arguments.Integer("windows");
  if (windows < 1) return;
  BenchReport report;
  report.title = "Training windows of 81 frames";
  report.label_columns = {"what"};
  report.value_columns = {"processor_us", "wall_us", "windows_a_second"};
  report.summarise = false;
  for (const int threads : {1, 2}) {
    const Times times = Measure(windows, [&] {
      constexpr int kBatch = 32;
      ParallelFor((windows + kBatch - 1) / kBatch, threads, [&](int batch) {
        LifterWindow window;
        for (int i = batch * kBatch; i < std::min(windows, (batch + 1) * kBatch); ++i)
          generator.Generate(static_cast<uint64_t>(i), &window);
      });
    });
    report.rows.push_back({"whole",
                           {threads == 1 ? "one thread" : "two threads"},
                           {threads == 1 ? times.processor_us : kNone, times.wall_us, 1e6 / times.wall_us}});
  }
  const int few = std::min(windows, 500);
  std::vector<LifterPerson> persons(few);
  std::vector<PoseSequence> poses(few);
  std::vector<LifterScene> scenes(few);
  std::vector<LifterFrames> frames(few);
  LifterWindow window;
  const auto stage = [&](const char* what, const std::function<void(int)>& work) {
    const Times times = Measure(few, [&] {
      for (int i = 0; i < few; ++i) work(i);
    });
    report.rows.push_back({"by stage, one thread", {what}, {times.processor_us, times.wall_us, kNone}});
  };
  stage("person", [&](int i) { persons[i] = generator.MakePerson(i); });
  stage("poses", [&](int i) { poses[i] = generator.MakePoses(i, persons[i]); });
  stage("landmarks, camera", [&](int i) { scenes[i] = generator.MakeScene(i, persons[i], poses[i]); });
  stage("detections", [&](int i) { frames[i] = generator.Detect(i, scenes[i]); });
  stage("features, targets", [&](int i) { generator.MakeWindow(i, scenes[i], frames[i], &window); });
  report.notes = {"best of three rounds"};
  report.command = command;
  std::fputs(BenchText(report).c_str(), stdout);
  if (!arguments.Text("json").empty()) WriteFileAtomically(arguments.Text("json"), BenchJson(report));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_lifter_windows", argc, argv,
                             {{"motion", ""},
                              {"windows", "4000"},
                              {"json", ""},
                              {"picture", ""},
                              {"first", "0"},
                              {"floor_poses", ""},
                              {"floor_share", ""}},
                             bodyloom::Run);
}
