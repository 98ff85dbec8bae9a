// SPDX-License-Identifier: Apache-2.0
/// Time and error of a Gaussian avatar: posing, projection, image, and backward pass.
///
///   bodyloom_bench_avatar [--gaussians 16000,32000] [--repetitions 60] [--json F]
///
/// Gaussians on the texels of the built-in body's skin (an atlas of about the requested size), posed with bent limbs,
/// in an image of 512² (person about 460 px high) and of 1920×1080 (900 px). Milliseconds, medians over the
/// repetitions, one row per stage, one for a whole frame and one for a whole training step (forward and backward,
/// without a loss): wall time with one thread, processor time of that thread, wall time with two, and the minimum of
/// each wall time. Processor time is the most comparable on a busy machine. error: for a frame, the maximum difference
/// of a plane from the image in double (tests/support/splat_twin.h) over a hundred pixels not sensitive to rounding;
/// for a step, the share of bytes of derivatives that differ between one thread and two, which is 0.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/atomic_file.h"
#include "geometry/base/stopwatch.h"
#include "geometry/math/rotation.h"
#include "render/gaussian_avatar/pose_gradient.h"
#include "render/gaussian_avatar/skin_gaussians.h"
#include "render/raster/raster_simd.h"
#include "render/splat/project_gaussians.h"
#include "render/splat/splat_gradient.h"
#include "tests/support/splat_twin.h"

namespace bodyloom {
namespace {

const double kNone = std::numeric_limits<double>::quiet_NaN();

/// Of this thread alone.
double ProcessorSeconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// One person in one image, with all data kept between frames.
struct Scene {
  const BodyModel& model = BuiltinBody();
  AvatarFrames frames{model, Eigen::VectorXd()};
  GaussianBody body;
  BodyPose pose;
  Camera camera;
  PixelBox window;

  AvatarFrame frame;
  CameraGaussians posed;
  ScreenGaussians screen;
  SplatImage image;
  FloatColumns by_planes, by_screen, by_posed;
  SplatGradient splat_gradient;
  PoseGradient pose_gradient;
  AvatarGradient gradient;

  Scene(int gaussians, int width, int height, double person_px) {
    // The share of the atlas that shows the surface gives its size.
    const double share = BuildUvTexelTable(model, {.width = 128, .height = 128}).Coverage();
    const int side = static_cast<int>(std::lround(std::sqrt(gaussians / share)));
    body = SkinGaussians(model, {}, BuildUvTexelTable(model, {.width = side, .height = side}));
    Eigen::VectorXd angles = Eigen::VectorXd::Zero(72);
    const auto turn = [&](int joint, double x, double y, double z) {
      angles.segment<3>(3 * joint) = Eigen::Vector3d(x, y, z);
    };
    turn(16, 0, 0, -1.0), turn(17, 0, 0, 0.9), turn(18, 0, -0.7, 0), turn(19, 0, 0.9, 0);
    turn(1, -0.5, 0, 0.1), turn(2, 0.2, 0, -0.1), turn(4, 0.6, 0, 0), turn(3, 0.1, 0.2, 0);
    turn(0, M_PI, 0, 0);
    pose = PoseFromAxisAngle(model, angles, Eigen::Vector3d::Zero());
    MatrixX3d vertices = PoseVertices(model, Eigen::VectorXd(), pose);
    const Eigen::RowVector3d low = vertices.colwise().minCoeff(), high = vertices.colwise().maxCoeff();
    pose.trans -= 0.5 * (low + high).transpose();
    pose.trans.z() += 4;
    camera = MakePinhole(width, height, 4 * person_px / (high.y() - low.y()));
    vertices.rowwise() += pose.trans.transpose();
    window = {width, height, 0, 0};
    for (int v = 0; v < vertices.rows(); ++v) {
      Eigen::Vector2d pixel;
      camera.Project(vertices.row(v).transpose(), &pixel);
      window.x_begin = std::min(window.x_begin, static_cast<int>(pixel.x()));
      window.y_begin = std::min(window.y_begin, static_cast<int>(pixel.y()));
      window.x_end = std::max(window.x_end, static_cast<int>(pixel.x()) + 1);
      window.y_end = std::max(window.y_end, static_cast<int>(pixel.y()) + 1);
    }
    window = window.GrownBy(8).ClippedTo({0, 0, width, height});
  }

  void MakeFrame(int threads) { frames.Make(pose, {}, threads, &frame); }
  void Pose(int threads) { PoseGaussians(body, model.data().faces, frame, {.num_threads = threads}, &posed); }
  void Project(int threads) { ProjectGaussians(posed, camera, {.num_threads = threads}, &screen); }
  void Draw(int threads) { image.Draw(screen, window, {.num_threads = threads}); }
  void SplatBack(int threads) { splat_gradient.Compute(image, screen, by_planes, threads, &by_screen); }
  void ProjectBack(int threads) {
    ProjectGaussiansBackward(posed, screen, by_screen, camera, {.num_threads = threads}, &by_posed);
  }
  void PoseBack(int threads) {
    pose_gradient.Compute(body, model.data().faces, frame, {.num_threads = threads}, by_posed, &gradient);
  }
  /// A loss's derivatives: any will do.
  void MakeLoss() {
    by_planes.Resize(SplatImage::kNumPlanes, image.planes().rows());
    std::mt19937 generator(1);
    for (int p = 0; p < by_planes.columns(); ++p) {
      for (float& g : by_planes.values(p)) g = static_cast<float>(generator() / 2147483648.0 - 1);
    }
  }
};

/// Seconds of the stages of one frame or step, in their order.
using Stages = std::vector<double>;

Stages Step(Scene* scene, int threads, std::vector<double>* processor) {
  Stages wall;
  processor->clear();
  const auto stage = [&](const auto& work) {
    const Stopwatch watch;
    const double start = ProcessorSeconds();
    work();
    processor->push_back(ProcessorSeconds() - start);
    wall.push_back(watch.seconds());
  };
  stage([&] { scene->MakeFrame(threads); });
  stage([&] { scene->Pose(threads); });
  stage([&] { scene->Project(threads); });
  stage([&] { scene->Draw(threads); });
  stage([&] { scene->SplatBack(threads); });
  stage([&] { scene->ProjectBack(threads); });
  stage([&] { scene->PoseBack(threads); });
  // The image stage in two parts: its sort, and the rest.
  const double sort = scene->image.summary().sort_seconds;
  wall.insert(wall.begin() + 3, sort);
  wall[4] -= sort;
  processor->insert(processor->begin() + 3, 0.0);  // in the next one's
  return wall;
}

double ImageError(const Scene& scene) {
  std::vector<TwinSplat<double>> splats;
  for (int i = 0; i < scene.screen.size(); ++i) {
    if (!scene.screen.IsDrawn(i)) continue;
    splats.push_back(TwinSplatOf(RowOf<double, ScreenGaussians::kNumGradients>(scene.screen.columns, i),
                                 scene.screen.columns(i, ScreenGaussians::kDepth)));
  }
  double worst = 0;
  const int num_pixels = static_cast<int>(scene.window.area());
  for (int i = 0; i < num_pixels; i += std::max(37, num_pixels / 100)) {
    const int x = scene.window.x_begin + i % scene.window.width(), y = scene.window.y_begin + i / scene.window.width();
    const auto twin = TwinDraw(splats, {x, y, x + 1, y + 1}, scene.image.options().stop_transmittance, 1e-4);
    if (twin.marginal[0]) continue;
    for (int p = 0; p < 4; ++p) worst = std::max(worst, std::abs(twin.planes[p][0] - scene.image.planes()(i, p)));
  }
  return worst;
}

void Measure(int gaussians, int width, int height, double person_px, int repetitions, BenchReport* report) {
  Scene scene(gaussians, width, height, person_px);
  static const std::vector<std::string> kStages = {
      "bones and correctives",         "pose",         "project",       "sort",
      "raster (processor: with sort)", "back: raster", "back: project", "back: pose"};
  const size_t num_stages = kStages.size(), num_forward = 5;
  std::vector<double> processor;
  scene.MakeFrame(1), scene.Pose(1), scene.Project(1), scene.Draw(1), scene.MakeLoss();
  // Rows: the stages, the frame, the step. Columns: samples.
  std::vector<std::vector<double>> one(num_stages + 2), spent(num_stages + 2), two(num_stages + 2);
  const auto add = [&](const std::vector<double>& seconds, std::vector<std::vector<double>>* to) {
    double sum = 0;
    for (size_t s = 0; s < num_stages; ++s) {
      (*to)[s].push_back(1e3 * seconds[s]);
      sum += 1e3 * seconds[s];
      if (s + 1 == num_forward) (*to)[num_stages].push_back(sum);
    }
    (*to)[num_stages + 1].push_back(sum);
  };
  double differing = 0;
  FloatColumns before;
  for (int r = -2; r < repetitions; ++r) {
    const Stages first = Step(&scene, 1, &processor);
    if (r >= 0) add(first, &one), add(processor, &spent);
    before = scene.gradient.parameters;
    const Stages second = Step(&scene, 2, &processor);
    if (r >= 0) add(second, &two);
    const FloatColumns& after = scene.gradient.parameters;
    for (int c = 0; c < after.columns(); ++c) {
      differing += std::memcmp(before.column(c), after.column(c), sizeof(float) * after.rows()) != 0;
    }
  }
  const double error = ImageError(scene);
  char group[120];
  std::snprintf(group, sizeof(group), "%d Gaussians, %dx%d, window %dx%d, %d drawn, %.2f tiles each", scene.body.size(),
                width, height, scene.window.width(), scene.window.height(), scene.image.summary().drawn,
                double(scene.image.summary().meetings) / scene.image.summary().drawn);
  for (size_t s = 0; s < num_stages + 2; ++s) {
    const std::string what = s < num_stages ? "  " + kStages[s] : s == num_stages ? "frame" : "step";
    report->rows.push_back(
        {group,
         {what},
         {Median(one[s]), kStages[std::min(s, num_stages - 1)] == "sort" ? kNone : Median(spent[s]), Median(two[s]),
          *std::min_element(one[s].begin(), one[s].end()), *std::min_element(two[s].begin(), two[s].end()),
          s == num_stages  ? 1e6 * error
          : s > num_stages ? differing
                           : kNone}});
  }
}

void Run(const BenchArguments& arguments, const std::string& command) {
  BenchReport report;
  report.title = "A person of Gaussians (built-in body's skin)";
  report.command = command;
  report.label_columns = {"what"};
  report.value_columns = {"1 thread_median_ms", "1 thread_processor_ms", "2 threads_median_ms",
                          "1 thread_least_ms",  "2 threads_least_ms",    "error_1e-6"};
  report.summarise = false;
  report.notes = {"instruction set: " + raster_internal::ChosenSimdTarget()};
  for (const std::string& count : arguments.List("gaussians")) {
    Measure(std::stoi(count), 512, 512, 460, arguments.Integer("repetitions"), &report);
    Measure(std::stoi(count), 1920, 1080, 900, arguments.Integer("repetitions"), &report);
  }
  std::printf("%s", BenchText(report).c_str());
  if (!arguments.Text("json").empty()) WriteFileAtomically(arguments.Text("json"), BenchJson(report));
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain("bodyloom_bench_avatar", argc, argv,
                             {{"gaussians", "16000,32000"}, {"repetitions", "60"}, {"json", ""}}, bodyloom::Run);
}
