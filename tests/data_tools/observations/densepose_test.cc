// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <set>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/densepose_iuv.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/video/image_file.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/raster/visible_points.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"
#include "tests/support/toy_body.h"
#include "tracking/detection/iuv_to_dense.h"

namespace bodyloom::densepose_test {
namespace {

using ::testing::HasSubstr;

constexpr int kWidth = 320, kHeight = 400;

/// The toy body, turned a little, as DensePose would label it: bytes rounded down.
struct LabelledView {
  MatrixX3d vertices;
  Camera camera = MakePinhole(kWidth, kHeight, 500);
  IuvImage iuv;
};

LabelledView MakeView(double shift_m = 0) {
  const BodyModel& body = ToyBody();
  LabelledView view;
  BodyPose pose = PoseFromAxisAngle(body, Eigen::VectorXd::Zero(72), Eigen::Vector3d::Zero());
  // Body y up, camera y down: a half turn about x, then a little about the vertical.
  pose.rotations[0] = RotationFromAxisAngle({M_PI, 0, 0}) * RotationFromAxisAngle({0, 0.4, 0});
  pose.trans = {shift_m, 0.1, 3.0};
  view.vertices = PoseVertices(body, Eigen::VectorXd(), pose);
  VisibilityBuffer buffer;
  buffer.Render(view.vertices, body.data().faces, view.camera);
  VisiblePointsRequest request;
  request.part = request.chart_uv = true;
  const VisiblePoints points = ResolveVisiblePoints(buffer, body, view.vertices, view.camera, request);
  view.iuv.width = kWidth;
  view.iuv.height = kHeight;
  for (auto* channel : {&view.iuv.part, &view.iuv.u, &view.iuv.v}) channel->assign(kWidth * kHeight, 0);
  for (size_t k = 0; k < points.size(); ++k) {
    const size_t i = size_t(points.y[k]) * kWidth + points.x[k];
    view.iuv.part[i] = points.part[k];
    view.iuv.u[i] = static_cast<uint8_t>(std::floor(255 * points.chart_uv[k].x()));
    view.iuv.v[i] = static_cast<uint8_t>(std::floor(255 * points.chart_uv[k].y()));
  }
  return view;
}

void WritePng(const std::string& path, const IuvImage& iuv, bool blue_is_part) {
  Image image(iuv.width, iuv.height);
  for (size_t i = 0; i < iuv.part.size(); ++i) {
    image.bgr[3 * i + (blue_is_part ? 0 : 2)] = iuv.part[i];
    image.bgr[3 * i + 1] = iuv.u[i];
    image.bgr[3 * i + (blue_is_part ? 2 : 0)] = iuv.v[i];
  }
  WriteImage(path, image);
}

TEST(DensePose, BothChannelOrdersAreRead) {
  const TemporaryFolder folder;
  const LabelledView view = MakeView();
  for (const bool blue_is_part : {true, false}) {
    const std::string path = folder.File("a_IUV.png");
    WritePng(path, view.iuv, blue_is_part);
    const IuvImage read = ReadIuvImage(path);
    EXPECT_EQ(read.order, blue_is_part ? IuvOrder::kBlueIsPart : IuvOrder::kRedIsPart);
    EXPECT_TRUE(read.part == view.iuv.part && read.u == view.iuv.u && read.v == view.iuv.v);
    const IuvOrder wrong = blue_is_part ? IuvOrder::kRedIsPart : IuvOrder::kBlueIsPart;
    EXPECT_THAT(FileErrorOf("a_IUV.png", [&] { ReadIuvImage(path, wrong); }), HasSubstr("expected parts 0 to 24 in"));
  }
}

TEST(DensePose, LabelsComeBackAsTheSurfacePointsTheyShow) {
  const LabelledView view = MakeView();
  const ChartLookup charts(ToyBody());
  IuvToDenseOptions options;
  options.per_frame = 600;
  options.sigma_px = 1.5;
  const std::vector<DenseKeypoint> points = IuvToDense(view.iuv, charts, options);
  ASSERT_EQ(points.size(), 600U);
  double sum = 0, worst = 0;
  Eigen::Vector2d bias = Eigen::Vector2d::Zero();
  for (const DenseKeypoint& point : points) {
    EXPECT_NEAR(point.barycentric.sum(), 1, 1e-5);
    EXPECT_EQ(point.sigma_px, 1.5F);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
      x += double{point.barycentric[c]} * view.vertices.row(ToyBody().data().faces(point.face, c)).transpose();
    Eigen::Vector2d pixel;
    ASSERT_TRUE(view.camera.Project(x, &pixel));
    const Eigen::Vector2d error = pixel - point.pixel.cast<double>();
    sum += error.norm();
    worst = std::max(worst, error.norm());
    bias += error / 600;
  }
  // 1/255 of a chart that spans some 90 pixels, halved and spread over two axes.
  EXPECT_LT(sum / 600, 0.3);
  EXPECT_LT(worst, 3);
  EXPECT_LT(bias.norm(), 0.05) << "bytes are rounded down: half a step is added back";
}

TEST(DensePose, ChartsThatWereNotRoundedComeBackWithinAHundredthOfAPixel) {
  const BodyModel& body = ToyBody();
  const LabelledView view = MakeView();
  VisibilityBuffer buffer;
  buffer.Render(view.vertices, body.data().faces, view.camera);
  const VisiblePoints visible =
      ResolveVisiblePoints(buffer, body, view.vertices, view.camera, {.part = true, .chart_uv = true});
  ChartImage image;
  image.x_begin = 40;
  image.y_begin = 30;
  image.width = kWidth - 40;
  image.height = kHeight - 30;
  image.part.assign(size_t(image.width) * size_t(image.height), 0);
  image.u.assign(image.part.size(), 0);
  image.v.assign(image.part.size(), 0);
  for (size_t k = 0; k < visible.size(); ++k) {
    if (visible.x[k] < 40 || visible.y[k] < 30) continue;
    const size_t i = size_t(visible.y[k] - 30) * size_t(image.width) + size_t(visible.x[k] - 40);
    image.part[i] = visible.part[k];
    image.u[i] = float(visible.chart_uv[k].x());
    image.v[i] = float(visible.chart_uv[k].y());
  }
  const std::vector<DenseKeypoint> points = IuvToDense(image, ChartLookup(body), {.per_frame = 500, .sigma_px = 2});
  ASSERT_EQ(points.size(), 500U);
  double sum = 0;
  for (const DenseKeypoint& point : points) {
    EXPECT_EQ(point.sigma_px, 2);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c)
      x += double{point.barycentric[c]} * view.vertices.row(body.data().faces(point.face, c)).transpose();
    Eigen::Vector2d pixel;
    ASSERT_TRUE(view.camera.Project(x, &pixel));
    sum += (pixel - point.pixel.cast<double>()).norm();
  }
  EXPECT_LT(sum / 500, 0.01) << "bytes: 0.3";
}

TEST(DensePose, SamplingIsStratified) {
  const LabelledView view = MakeView();
  const ChartLookup charts(ToyBody());
  IuvToDenseOptions options;
  options.per_frame = 0;
  const size_t all = IuvToDense(view.iuv, charts, options).size();
  options.per_frame = 400;
  const std::vector<DenseKeypoint> some = IuvToDense(view.iuv, charts, options);
  ASSERT_GT(all, 8000U);
  ASSERT_EQ(some.size(), 400U);
  std::array<double, 25> share_all{}, share_some{};
  for (const uint8_t part : view.iuv.part) share_all[part] += part > 0 ? 1.0 / static_cast<double>(all) : 0;
  std::set<std::pair<int, int>> cells;
  for (const DenseKeypoint& point : some) {
    share_some[ToyBody().data().face_part[point.face]] += 1.0 / 400;
    cells.emplace(static_cast<int>(point.pixel.x()) / 8, static_cast<int>(point.pixel.y()) / 8);
  }
  for (int p = 1; p <= 24; ++p) EXPECT_NEAR(share_some[p], share_all[p], 1.0 / 400) << p;
  EXPECT_GT(cells.size(), 190U) << "evenly spread, not clumped";
  // The same pixels every time.
  const std::vector<DenseKeypoint> again = IuvToDense(view.iuv, charts, options);
  for (size_t k = 0; k < 400; ++k) EXPECT_EQ(again[k].pixel, some[k].pixel);
}

TEST(DensePose, PixelsFarOutsideTheirChartAreDropped) {
  IuvImage iuv;
  iuv.width = 2;
  iuv.height = 1;
  iuv.part = {1, 24};
  iuv.u = {255, 128};
  iuv.v = {255, 128};
  const ChartLookup charts(ToyBody());
  double gap = 0;
  ASSERT_GE(charts.Find(1, {1, 1}, &gap).face, 0);
  IuvToDenseOptions options;
  options.max_gap = gap / 2;
  EXPECT_EQ(IuvToDense(iuv, charts, options).size(), 1U);
  options.max_gap = gap * 2;
  EXPECT_EQ(IuvToDense(iuv, charts, options).size(), 2U);
  options.sigma_px = 0;
  EXPECT_THROW(IuvToDense(iuv, charts, options), std::invalid_argument);
}

TEST(DensePose, FolderWithInstancesAndGaps) {
  const TemporaryFolder folder;
  const LabelledView one = MakeView(), two = MakeView(0.02);
  // A second, smaller person: a block of part 1 in the corner.
  const auto with_block = [](IuvImage iuv, std::vector<uint8_t>* instance, uint8_t person, uint8_t block) {
    instance->assign(iuv.part.size(), 0);
    for (size_t i = 0; i < iuv.part.size(); ++i) (*instance)[i] = iuv.part[i] > 0 ? person : 0;
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 20; ++x) {
        iuv.part[size_t(y) * kWidth + x] = 1;
        iuv.u[size_t(y) * kWidth + x] = iuv.v[size_t(y) * kWidth + x] = 128;
        (*instance)[size_t(y) * kWidth + x] = block;
      }
    }
    return iuv;
  };
  const auto write_instance = [&](const std::string& name, const std::vector<uint8_t>& instance) {
    Image image(kWidth, kHeight);
    for (size_t i = 0; i < instance.size(); ++i) {
      for (int c = 0; c < 3; ++c) image.bgr[3 * i + c] = instance[i];
    }
    WriteImage(folder.File(name), image);
  };
  std::vector<uint8_t> instance;
  WritePng(folder.File("f_0010_IUV.png"), with_block(one.iuv, &instance, 1, 2), true);
  write_instance("f_0010_INDS.png", instance);
  WritePng(folder.File("f_0012_IUV.png"), with_block(two.iuv, &instance, 2, 1), true);  // the numbers change
  write_instance("f_0012_INDS.png", instance);
  WritePng(folder.File("f_0013_IUV.png"), two.iuv, true);
  EXPECT_TRUE(HoldsDenseKeypoints(folder.File("")));
  LoadDenseOptions options;
  options.fps = 10;
  options.sampling.per_frame = 300;
  const DenseSequence dense = LoadDense(folder.File(""), ToyBody(), options);
  ASSERT_EQ(dense.num_frames(), 4);
  EXPECT_NEAR(dense.timestamps[0], 1.0, 1e-12);
  EXPECT_EQ(dense.frames[0].size(), 300U);
  EXPECT_TRUE(dense.frames[1].empty()) << "frame 11 is missing";
  for (const int t : {0, 2}) {
    for (const DenseKeypoint& point : dense.frames[t]) EXPECT_GT(point.pixel.norm(), 29) << "not the other person";
  }
  options.person = 1;
  const DenseSequence other = LoadDense(folder.File(""), ToyBody(), options);
  for (const DenseKeypoint& point : other.frames[2]) {
    EXPECT_LT(point.pixel.maxCoeff(), 20);
  }
  options.person = 2;
  EXPECT_THAT(FileErrorOf("f_0010_INDS.png", [&] { LoadDense(folder.File(""), ToyBody(), options); }),
              HasSubstr("only 2 are in this frame"));
  EXPECT_EQ(LoadDense(folder.File("f_0013_IUV.png"), ToyBody()).num_frames(), 1);

  // The noise lies on the surface unless the caller says otherwise.
  EXPECT_EQ(dense.uv_sigma, kDensePoseUvSigma);
  EXPECT_GT(kDensePoseUvSigma, 1 / (255 * std::sqrt(12.0)));
  EXPECT_NEAR(dense.pixel_sigma_px, 1 / std::sqrt(12.0), 1e-12);
  for (const double uv_sigma : {0.0, 0.1}) {
    options.uv_sigma = uv_sigma;
    EXPECT_EQ(LoadDense(folder.File("f_0013_IUV.png"), ToyBody(), options).uv_sigma, uv_sigma);
  }
}

TEST(DensePose, MalformedImages) {
  const TemporaryFolder folder;
  const LabelledView view = MakeView();
  const std::string path = folder.File("a_IUV.png");
  WritePng(path, view.iuv, true);
  const std::string bytes = ReadFileBytes(path);
  const auto error = [&](const std::string& content) {
    WriteFileAtomically(path, content);
    return FileErrorOf("a_IUV.png", [&] { ReadIuvImage(path); });
  };
  for (size_t n = 0; n < bytes.size(); n += bytes.size() / 40) error(bytes.substr(0, n));
  std::string damaged = bytes;
  damaged[bytes.size() / 2] ^= 1;
  EXPECT_THAT(error(damaged), HasSubstr("a chunk of the PNG is damaged"));
  EXPECT_THAT(error("\xff\xd8\xff\xe0 a JPEG"), HasSubstr("not a PNG"));
  std::string deep = bytes;
  deep[24] = 16;
  EXPECT_THAT(error(deep), HasSubstr("16 bits"));
  std::string grey = bytes;
  grey[25] = 0;
  EXPECT_THAT(error(grey), HasSubstr("expected 8-bit colour"));
  std::string huge = bytes;
  huge[16] = huge[20] = 0x7f;
  EXPECT_THAT(error(huge), HasSubstr("pixels, expected 1 to"));
  Image photo(16, 16, {200, 100, 50});
  WriteImage(path, photo);
  EXPECT_THAT(FileErrorOf("a_IUV.png", [&] { ReadIuvImage(path); }), HasSubstr("blue reaches 50 and red 200"));
  // Frames that do not belong together.
  WritePng(folder.File("a_1_IUV.png"), view.iuv, true);
  std::filesystem::remove(path);
  IuvImage small;
  small.width = small.height = 4;
  small.part.assign(16, 1);
  small.u.assign(16, 100);
  small.v.assign(16, 100);
  WritePng(folder.File("a_2_IUV.png"), small, true);
  EXPECT_THAT(FileErrorOf("a_2_IUV.png", [&] { LoadDense(folder.File(""), ToyBody()); }),
              HasSubstr("4x4 pixels, expected 320x400"));
  WritePng(folder.File("a_2_IUV.png"), view.iuv, false);
  EXPECT_THAT(FileErrorOf("a_2_IUV.png", [&] { LoadDense(folder.File(""), ToyBody()); }),
              HasSubstr("parts 0 to 24 in blue"));
  WriteImage(folder.File("a_1_INDS.png"), photo);
  EXPECT_THAT(FileErrorOf("a_1_INDS.png", [&] { LoadDense(folder.File(""), ToyBody()); }), HasSubstr("16x16 pixels"));
}

TEST(DensePose, WrongPathsAndBodies) {
  const TemporaryFolder folder;
  EXPECT_THAT(FileErrorOf(folder.File(""), [&] { LoadDense(folder.File(""), ToyBody()); }),
              HasSubstr("no files *_IUV.png"));
  FileErrorOf("x.png", [&] { LoadDense(folder.File("x.png"), ToyBody()); });
  IuvImage empty;
  empty.width = empty.height = 8;
  for (auto* channel : {&empty.part, &empty.u, &empty.v}) channel->assign(64, 0);
  WritePng(folder.File("e_IUV.png"), empty, true);
  EXPECT_THAT(FileErrorOf(folder.File(""), [&] { LoadDense(folder.File(""), ToyBody()); }), HasSubstr("no pixel of 1"));
  BodyModelData data = ToyBodyData();
  data.face_part.clear();
  data.face_iuv.resize(0, 6);
  EXPECT_THROW(LoadDense(folder.File(""), BodyModel(data)), std::invalid_argument);
  DenseSequence dense;
  dense.timestamps = {0};
  dense.frames = {{{1'000'000, {1, 0, 0}, {1, 1}, 1}}};
  WriteObservations(folder.File("d.npz"), nullptr, &dense);
  EXPECT_TRUE(HoldsDenseKeypoints(folder.File("d.npz")));
  EXPECT_THAT(FileErrorOf("d.npz", [&] { LoadDense(folder.File("d.npz"), ToyBody()); }),
              HasSubstr("names face 1000000"));
  EXPECT_FALSE(HoldsDenseKeypoints(folder.File("nothing.npz")));
  EXPECT_FALSE(HoldsDenseKeypoints(folder.File("nothing")));
}

}  // namespace
}  // namespace bodyloom::densepose_test
