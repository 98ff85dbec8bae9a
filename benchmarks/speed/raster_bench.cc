// SPDX-License-Identifier: Apache-2.0
/// Time and error of the rasteriser, its resolve pass and the overlay, on the built-in body.
///
///   bodyloom_bench_raster [--sizes 128,256,512,1024] [--repetitions 100] [--json F]
///
/// The body in T-pose, from the front, fills a square image. px_wrong: pixels whose face or depth is not that of the
/// twin (tests/support/raster_twin.h), to the bit; for Embree, pixels whose face differs away from edges
/// (tests/support/embree_twin.h). uv_error: largest difference of a chart coordinate to the double-precision path.
/// Times per image, milliseconds: median and minimum with one thread, median and minimum with two.
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
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "render/raster/raster_simd.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"
#include "render/raster/visible_points.h"
#include "render/view/overlay.h"
#include "tests/support/raster_twin.h"
#ifdef BODYLOOM_HAS_EMBREE
#include "tests/support/embree_twin.h"
#endif

namespace bodyloom {
namespace {

const double kNone = std::numeric_limits<double>::quiet_NaN();

struct Times {
  double processor_ms, median_ms, min_ms;
};

/// Of this thread alone.
double ProcessorSeconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Times Measure(int repetitions, const std::function<void()>& work) {
  std::vector<double> wall, processor;
  work();
  for (int i = 0; i < repetitions; ++i) {
    const Stopwatch watch;
    const double processor_start = ProcessorSeconds();
    work();
    processor.push_back(1e3 * (ProcessorSeconds() - processor_start));
    wall.push_back(1e3 * watch.seconds());
  }
  std::sort(wall.begin(), wall.end());
  std::sort(processor.begin(), processor.end());
  return {processor[processor.size() / 2], wall[wall.size() / 2], wall[0]};
}

/// The template upright in front of a camera whose square image it fills.
struct Scene {
  MatrixX3d vertices = BuiltinBody().data().v_template;
  Camera camera;
  explicit Scene(int size) {
    vertices.col(1) *= -1;
    vertices.col(2) *= -1;
    const Eigen::RowVector3d low = vertices.colwise().minCoeff(), high = vertices.colwise().maxCoeff();
    vertices.rowwise() -= 0.5 * (low + high);
    vertices.col(2).array() += 4;
    camera = MakePinhole(size, size, 3.9 * size / std::max(high.x() - low.x(), high.y() - low.y()));
  }
};

BenchRow Row(const std::string& group, const std::string& what, int repetitions, const std::function<void(int)>& work,
             const std::vector<double>& errors) {
  const Times one = Measure(repetitions, [&] { work(1); }), two = Measure(repetitions, [&] { work(2); });
  BenchRow row{group, {what}, {one.processor_ms, one.median_ms, one.min_ms, two.median_ms, two.min_ms}};
  row.values.insert(row.values.end(), errors.begin(), errors.end());
  return row;
}

double WrongPixels(const VisibilityBuffer& buffer, const TwinImage& twin, int* covered) {
  int wrong = 0;
  *covered = 0;
  for (int y = 0; y < twin.height; ++y) {
    for (int x = 0; x < twin.width; ++x) {
      const size_t at = size_t(y) * twin.width + x;
      const int face = buffer.FaceAt(x, y);
      *covered += face >= 0;
      wrong +=
          face != twin.face[at] || (face >= 0 && buffer.nearness()[buffer.box().IndexOf(x, y)] != twin.nearness[at]);
    }
  }
  return wrong;
}

double UvError(const VisibilityBuffer& buffer, const Scene& scene, const ResolvedPixels& pixels) {
  const VisiblePoints points =
      ResolveVisiblePoints(buffer, BuiltinBody(), scene.vertices, scene.camera, {.chart_uv = true});
  float worst = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const float* uv = &pixels.chart_uv[2 * pixels.box.IndexOf(points.x[i], points.y[i])];
    worst = std::max({worst, std::abs(uv[0] - points.chart_uv[i].x()), std::abs(uv[1] - points.chart_uv[i].y())});
  }
  return worst;
}

#ifdef BODYLOOM_HAS_EMBREE
BenchRow EmbreeRow(const std::string& group, const Scene& scene, const VisibilityBuffer& buffer, int repetitions) {
  const MatrixX3i& faces = BuiltinBody().data().faces;
  EmbreeTwin embree(faces);
  const Times one = Measure(repetitions, [&] { embree.See(scene.vertices, scene.camera, 0.01); });
  int wrong = 0, covered = 0;
  for (int y = 0; y < scene.camera.height; ++y) {
    for (int x = 0; x < scene.camera.width; ++x) {
      const int ours = buffer.FaceAt(x, y), theirs = embree.face[size_t(y) * scene.camera.width + x];
      covered += theirs >= 0;
      bool differs = ours != theirs;
      for (const int face : {ours, theirs}) {
        differs = differs && (face < 0 || DistanceToEdges(scene.vertices, faces, scene.camera, face, x, y) > 0.02);
      }
      wrong += differs;
    }
  }
  return {group,
          {"Embree: rebuild, packets of 8 rays"},
          {one.processor_ms, one.median_ms, one.min_ms, kNone, kNone, double(covered), double(wrong), kNone}};
}
#endif

void Square(int size, int repetitions, BenchReport* report) {
  const Scene scene(size);
  const BodyModel& body = BuiltinBody();
  const MatrixX3i& faces = body.data().faces;
  const std::string group = std::to_string(size) + " x " + std::to_string(size);
  VisibilityBuffer buffer;
  const auto see = [&](int threads) { buffer.Render(scene.vertices, faces, scene.camera, {.num_threads = threads}); };
  ResolvedPixels pixels;
  const auto resolve = [&](ResolveRequest request, int threads) {
    request.num_threads = threads;
    ResolvePixels(buffer, body, scene.vertices, scene.camera, request, &pixels);
  };
  const TwinImage twin = RasterTwin(scene.vertices, faces, scene.camera, true);
  int covered = 0;
  see(1);
  const double wrong = WrongPixels(buffer, twin, &covered);
  const auto add = [&](const std::string& what, double px_wrong, double uv_error,
                       const std::function<void(int)>& work) {
    report->rows.push_back(Row(group, what, repetitions, work, {double(covered), px_wrong, uv_error}));
  };
  add("face and depth", wrong, kNone, [&](int threads) { see(threads); });
  resolve({.part = true, .chart_uv = true}, 1);
  const double uv_error = UvError(buffer, scene, pixels);
  add("face, depth and IUV", wrong, uv_error, [&](int threads) {
    see(threads);
    resolve({.part = true, .chart_uv = true}, threads);
  });
  add("  resolve alone: part", kNone, kNone, [&](int threads) { resolve({.part = true}, threads); });
  add("  resolve alone: IUV", kNone, uv_error,
      [&](int threads) { resolve({.part = true, .chart_uv = true}, threads); });
  ResolveRequest all;
  all.part = all.chart_uv = all.atlas_uv = all.depth = all.normal = all.barycentric = true;
  add("  resolve alone: everything", kNone, uv_error, [&](int threads) { resolve(all, threads); });
#ifdef BODYLOOM_HAS_EMBREE
  report->rows.push_back(EmbreeRow(group, scene, buffer, std::max(5, repetitions / 5)));
#endif
}

/// Time saved by the person's box: a person 400 px wide and high in an image of 1920×1080.
void SmallPerson(int repetitions, BenchReport* report) {
  Scene scene(400);
  scene.camera.width = 1920, scene.camera.height = 1080;
  scene.camera.cx += 700, scene.camera.cy += 300;
  const BodyModel& body = BuiltinBody();
  VisibilityBuffer box, whole;
  ResolvedPixels pixels;
  const auto see = [&](VisibilityBuffer* buffer, bool is_whole, bool iuv) {
    return [&, buffer, is_whole, iuv](int threads) {
      buffer->Render(scene.vertices, body.data().faces, scene.camera,
                     {.num_threads = threads, .whole_image = is_whole});
      if (!iuv) return;
      ResolveRequest request{.part = true, .chart_uv = true};
      request.num_threads = threads;
      ResolvePixels(*buffer, body, scene.vertices, scene.camera, request, &pixels);
    };
  };
  see(&box, false, false)(1);
  see(&whole, true, false)(1);
  int covered = 0, differing = 0;
  for (int y = 0; y < 1080; ++y) {
    for (int x = 0; x < 1920; ++x) {
      covered += box.FaceAt(x, y) >= 0;
      differing += box.FaceAt(x, y) != whole.FaceAt(x, y) || box.DepthAt(x, y) != whole.DepthAt(x, y);
    }
  }
  for (const bool iuv : {false, true}) {
    const std::string what = iuv ? "face, depth and IUV" : "face and depth";
    report->rows.push_back(Row("Person of 400 px in 1920 x 1080", what, repetitions, see(&box, false, iuv),
                               {double(covered), double(differing), kNone}));
    report->rows.push_back(Row("Person of 400 px in 1920 x 1080", "  without the person's box", repetitions,
                               see(&whole, true, iuv), {double(covered), double(differing), kNone}));
  }
}

/// A standing person 646 px high over 1280×720 video frames that are in memory already.
void Overlay(int repetitions, BenchReport* report) {
  Track track;
  track.camera = MakePinhole(1280, 720, 1000);
  track.motion.up = Motion::Up::kCamera;
  track.motion.poses = RowMatrixXd::Zero(1, 72);
  track.motion.poses(0, 0) = M_PI;
  track.motion.poses(0, 3 * 16 + 2) = -0.9;
  track.motion.poses(0, 3 * 17 + 2) = 0.9;
  track.motion.trans = Eigen::RowVector3d(0, 0, 2.65);
  track.motion.timestamps = {0};
  track.frame_status = {FrameStatus::kTracked};
  const Image video(1280, 720, {90, 140, 60});
  OverlayOptions two;
  two.num_threads = 2;
  const Image a = OverlayRenderer(BuiltinBody(), track).Render(0, {.background = &video});
  const Image b = OverlayRenderer(BuiltinBody(), track, two).Render(0, {.background = &video});
  double differing = 0;
  for (size_t i = 0; i < a.bgr.size(); i += 3) {
    differing += !std::equal(&a.bgr[i], &a.bgr[i] + 3, &b.bgr[i]);
  }
  OverlayRenderer one_thread(BuiltinBody(), track), two_threads(BuiltinBody(), track, two);
  Image image;
  for (const bool caption : {false, true}) {
    OverlayFrame frame{.background = &video};
    if (caption) frame.caption = {{"frame 12, tracked"}};
    report->rows.push_back(Row("Overlay, 1280 x 720", caption ? "posing, shading, caption" : "posing and shading",
                               repetitions,
                               [&](int threads) { image = (threads == 1 ? one_thread : two_threads).Render(0, frame); },
                               {kNone, differing, kNone}));
  }
}

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "Rasteriser: built-in body (7,874 vertices, 15,744 faces), T-pose, fills the frame";
  report.command = command;
  report.label_columns = {"what"};
  report.value_columns = {"1 thread_processor_ms", "1 thread_median_ms", "1 thread_least_ms", "2 threads_median_ms",
                          "2 threads_least_ms",    "px_covered",         "px_wrong",          "uv_error_1e-6"};
  report.summarise = false;
  report.notes = {"instruction set: " + raster_internal::ChosenSimdTarget()};
  for (const std::string& size : arguments.List("sizes")) {
    Square(std::stoi(size), arguments.Integer("repetitions"), &report);
  }
  for (BenchRow& row : report.rows) row.values.back() *= 1e6;
  SmallPerson(arguments.Integer("repetitions"), &report);
  Overlay(arguments.Integer("repetitions"), &report);
  std::printf("%s", BenchText(report).c_str());
  if (!arguments.Text("json").empty()) WriteFileAtomically(arguments.Text("json"), BenchJson(report));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_raster", argc, argv,
                             {{"sizes", "128,256,512,1024"}, {"repetitions", "100"}, {"json", ""}}, bodyloom::Run);
}
