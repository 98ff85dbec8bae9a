// SPDX-License-Identifier: Apache-2.0
/// Fits the body to single images of people in hard poses, from 2D joints and a silhouette, and measures the distance
/// to another system's reconstruction of the same image (SAM 3D Body; shared/data/mhr_sam3d).
///
///   bodyloom_bench_hard_poses [--data DIR] [--threads 2] [--picture F.png] [--json F]
///
/// Both meshes have their own vertex order, so surfaces are compared by nearest points, each way, after moving our
/// mid-hip onto theirs ("placed": one camera does not see metric depth), and after a similarity fit of the 13 body
/// joints ("aligned"). Joints: 12 limb joints and the nose of COCO's 17. Each system has joint centres of its own, so
/// zero is not to be expected. The silhouette is their mesh's vertices, splatted and closed.
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "benchmarks/accuracy/bench_arguments.h"
#include "benchmarks/accuracy/bench_report.h"
#include "data_tools/body/builtin_body.h"
#include "data_tools/formats/npz.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/math/procrustes.h"
#include "render/view/contact_sheet.h"
#include "render/view/overlay.h"
#include "tests/support/paths.h"
#include "tracking/clip/clip_fit.h"

namespace bodyloom {
namespace {

struct Person {
  MatrixX3d vertices;  ///< camera frame, metres
  MatrixX3d joints;    ///< 17×3 in CocoNames() order; eyes and ears too
  KeypointSequence keypoints;
  PartLabelSequence mask;
  Camera camera;
};

/// Rows of SAM 3D Body's 70 keypoints for CocoNames(): its first 15 are COCO's without wrists.
constexpr std::array<int, 17> kCocoRows = {0, 1, 2, 3, 4, 5, 6, 7, 8, 62, 41, 9, 10, 11, 12, 13, 14};

/// Pixels within the person: every vertex a disc that bridges the gaps to its neighbours, then closed.
PartLabelSequence MaskOf(const MatrixX3d& vertices, const Camera& camera) {
  constexpr int kRadius = 5;
  cv::Mat mask = cv::Mat::zeros(camera.height, camera.width, CV_8U);
  for (Eigen::Index i = 0; i < vertices.rows(); ++i) {
    Eigen::Vector2d pixel;
    if (!camera.Project(vertices.row(i).transpose(), &pixel)) continue;
    cv::circle(mask, {static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))}, kRadius, 1,
               cv::FILLED);
  }
  cv::erode(mask, mask, cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * kRadius + 1, 2 * kRadius + 1}));
  PartLabelSequence labels;
  labels.timestamps = {0};
  labels.image_width = camera.width;
  labels.image_height = camera.height;
  labels.frames.emplace_back(
      LabelImage{0, 0, camera.width, camera.height, {mask.begin<uint8_t>(), mask.end<uint8_t>()}});
  labels.AsMask();
  return labels;
}

Person ReadPerson(const std::string& data, int subject, const NpzArrays& scene) {
  const std::string path = data + "/img_subj0" + std::to_string(subject) + ".npz";
  const NpzArrays arrays = ReadNpz(path);
  const auto matrix = [&](const char* key) { return RequireArray(arrays, key, path).ToMatrix(); };
  const Eigen::RowVector3d shift = matrix("pred_cam_t").transpose();
  Person person;
  person.vertices = matrix("pred_vertices").rowwise() + shift;
  const RowMatrixXd keypoints = matrix("pred_keypoints_3d"), pixels = matrix("pred_keypoints_2d");
  const RowMatrixXd K = RequireArray(scene, "K", data).ToMatrix();
  const std::vector<int64_t> size = RequireArray(scene, "image_size", data).ToInts();
  person.camera = MakePinhole(static_cast<int>(size[0]), static_cast<int>(size[1]), K(0, 0));
  person.camera.cx = K(0, 2);
  person.camera.cy = K(1, 2);
  person.joints.resize(17, 3);
  KeypointSequence& k = person.keypoints;
  k.names = CocoNames();
  k.timestamps = {0};
  k.image_width = person.camera.width;
  k.image_height = person.camera.height;
  for (int i = 0; i < 17; ++i) {
    person.joints.row(i) = keypoints.row(kCocoRows[i]) + shift;
    k.points.push_back(
        {static_cast<float>(pixels(kCocoRows[i], 0)), static_cast<float>(pixels(kCocoRows[i], 1)), 0.95F});
  }
  person.mask = MaskOf(person.vertices, person.camera);
  return person;
}

/// Mean distance from each point of `from` to the nearest of `to`, metres.
double NearestDistance(const MatrixX3d& from, const MatrixX3d& to) {
  double sum = 0;
  for (Eigen::Index i = 0; i < from.rows(); ++i) {
    sum += std::sqrt((to.rowwise() - from.row(i)).rowwise().squaredNorm().minCoeff());
  }
  return sum / static_cast<double>(from.rows());
}

Eigen::RowVector3d MidHip(const MatrixX3d& coco17) { return (coco17.row(11) + coco17.row(12)) / 2; }

/// The 13 joints that both systems mean alike: nose, shoulders to ankles.
MatrixX3d BodyJoints(const MatrixX3d& coco17) {
  MatrixX3d joints(13, 3);
  joints << coco17.row(0), coco17.bottomRows(12);
  return joints;
}

double MeanDistance(const MatrixX3d& a, const MatrixX3d& b) { return (a - b).rowwise().norm().mean(); }

Image DrawPose(const Person& person, const Track& track) {
  Image background(person.camera.width, person.camera.height, {245, 245, 245});
  int x_begin = background.width, x_end = 0;
  for (int y = 0; y < background.height; ++y) {
    for (int x = 0; x < background.width; ++x) {
      if (person.mask.PartAt(0, x, y) != 1) continue;
      for (int c = 0; c < 3; ++c) background.pixel(x, y)[c] = c == 2 ? 230 : 140;
      x_begin = std::min(x_begin, x);
      x_end = std::max(x_end, x);
    }
  }
  OverlayOptions options;
  options.alpha = 0.75;
  const OverlayRenderer renderer(BuiltinBody(), track, options);
  const Image whole = renderer.Render(0, {&background, &person.keypoints, {}});
  constexpr int kMargin = 60;
  Image cut(x_end - x_begin + 2 * kMargin, whole.height, {245, 245, 245});
  Paste(whole, kMargin - x_begin, 0, &cut);
  return cut;
}

void Run(const BenchArguments& arguments, const std::string& command) {
  const std::string data = arguments.Text("data");
  const NpzArrays scene = ReadNpz(data + "/smpltopo_dense_subj00_01.npz");
  BenchReport report;
  report.title = "Hard poses: one image, 2D joints and silhouette, against SAM 3D Body";
  report.command = command;
  report.label_columns = {"person", "from"};
  report.value_columns = {"mpjpe_mm",
                          "pa_mpjpe_mm",
                          "placed_to_theirs_mm",
                          "placed_from_theirs_mm",
                          "aligned_to_theirs_mm",
                          "aligned_from_theirs_mm",
                          "seconds"};
  report.notes = {"joints: nose and 12 limb joints, mid-hip on mid-hip; surfaces: nearest points, each way",
                  Concatenate("threads: ", arguments.Integer("threads"))};
  std::vector<Image> images;
  for (int subject = 0; subject < 2; ++subject) {
    const Person person = ReadPerson(data, subject, scene);
    for (const bool silhouette : {false, true}) {
      TrackSequenceInput input;
      input.body = &BuiltinBody();
      input.prior = &BuiltinPosePrior();
      input.keypoints = &person.keypoints;
      input.part_labels = silhouette ? &person.mask : nullptr;
      input.camera = person.camera;
      TrackSequenceOptions options;
      options.num_threads = arguments.Integer("threads");
      options.part_labels.clothes_sigma_share = 0;  // these masks are of bare bodies
      const Stopwatch watch;
      const TrackSequenceResult result = FitClip(input, options);
      const double seconds = watch.seconds();
      BODYLOOM_CHECK(result.summary.IsUsable(), "person ", subject, ": ", result.summary.message);
      const MatrixX3d ours = TrackVertices(BuiltinBody(), result.track, 0);
      const MatrixX3d& joints = result.track.coco17[0];
      const Eigen::RowVector3d shift = MidHip(person.joints) - MidHip(joints);
      const MatrixX3d placed = ours.rowwise() + shift;
      const MatrixX3d ours13 = BodyJoints(joints), theirs13 = BodyJoints(person.joints);
      const SimilarityTransform fit = AlignPoints(ours13, theirs13).target_from_source;
      const MatrixX3d aligned = fit.Apply(ours);
      report.rows.push_back(
          {"",
           {std::to_string(subject), silhouette ? "joints + silhouette" : "joints"},
           {1e3 * MeanDistance(ours13.rowwise() + shift, theirs13), 1e3 * MeanDistance(fit.Apply(ours13), theirs13),
            1e3 * NearestDistance(placed, person.vertices), 1e3 * NearestDistance(person.vertices, placed),
            1e3 * NearestDistance(aligned, person.vertices), 1e3 * NearestDistance(person.vertices, aligned),
            seconds}});
      images.push_back(DrawPose(person, result.track));
    }
  }
  HandOver(report, arguments.Text("json"));
  if (!arguments.Text("picture").empty()) {
    ContactSheetOptions sheet;
    sheet.columns = 4;
    sheet.cell_height_px = 720;
    WriteImage(arguments.Text("picture"), ContactSheet(images, sheet));
  }
}

}  // namespace
}  // namespace bodyloom

int main(int argc, char** argv) {
  return bodyloom::BenchMain(
      "bodyloom_bench_hard_poses", argc, argv,
      {{"data", bodyloom::SharedDir() + "/data/mhr_sam3d"}, {"threads", "2"}, {"picture", ""}, {"json", ""}},
      bodyloom::Run);
}
