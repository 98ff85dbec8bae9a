// SPDX-License-Identifier: Apache-2.0
#include "pipelines/animate/relight_frames.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr float kOpaque = 0.9F;
constexpr int kPixelsAFrame = 2000;

Vector3d VectorAt(const JsonNode& node) {
  const std::vector<double> values = node.Numbers(3);
  return {values[0], values[1], values[2]};
}

double NotNegative(const JsonNode& node) {
  const double value = node.Number();
  if (!(value >= 0)) node.Fail("a number that is not negative");
  return value;
}

ShLighting ReadDirectional(const JsonNode& node) {
  const Vector3d from = VectorAt(node.At("from"));
  if (!(from.norm() > 0)) node.At("from").Fail("a direction of length above 0");
  Vector3d colour = Vector3d::Ones();
  if (node.Has("colour")) {
    colour = VectorAt(node.At("colour"));
    if (colour.minCoeff() < 0) node.At("colour").Fail("three numbers that are not negative");
  }
  const double intensity = node.Has("intensity") ? NotNegative(node.At("intensity")) : 1;
  return DirectionalLight(CameraFromViewer(from), intensity * colour);
}

RelightRequest ReadJson(const std::string& path) {
  const nlohmann::json json = ReadJsonFile(path);
  const JsonNode root(json, path);
  if (!root.is_object() || !(root.Has("directional") || root.Has("ambient"))) {
    root.Fail("an object with \"directional\" or \"ambient\"");
  }
  const std::set<std::string> known = {"directional", "ambient", "estimate", "encoding"};
  for (const std::string& key : root.Keys()) {
    if (!known.contains(key)) root.At(key).Fail("directional, ambient, estimate or encoding");
  }
  RelightRequest request;
  if (root.Has("directional")) {
    const JsonNode lights = root.At("directional");
    if (!lights.is_array()) lights.Fail("an array of lights");
    for (size_t i = 0; i < lights.size(); ++i) request.light += ReadDirectional(lights.At(i));
  }
  if (root.Has("ambient")) request.light += AmbientLight(Vector3d::Constant(NotNegative(root.At("ambient"))));
  if (root.Has("estimate")) request.estimate = root.At("estimate").Flag();
  if (root.Has("encoding")) {
    const std::string text = root.At("encoding").Text();
    if (text != "srgb" && text != "linear") root.At("encoding").Fail("\"srgb\" or \"linear\"");
    if (text == "linear") request.encoding = PixelEncoding::kLinear;
  }
  if (request.light.isZero()) root.Fail("light: all intensities are 0");
  return request;
}

RelightRequest ReadEnvironment(const std::string& path) {
  RelightRequest request;
  request.light = EnvironmentLight(ReadImage(path), PixelEncoding::kSrgb);
  const double mean = LuminanceOf(request.light.col(0)) / EvenLight()[0];
  if (!(mean > 0)) throw std::runtime_error(path + ": the environment is black, expected light");
  request.light /= mean;
  return request;
}

}  // namespace

RelightRequest ReadRelight(const std::string& path) {
  return LowerExtension(path) == ".json" ? ReadJson(path) : ReadEnvironment(path);
}

void FrameRelighter::Observe(const MotionImage& rendered) {
  const size_t area = rendered.alpha.size();
  std::vector<size_t> usable;
  for (size_t i = 0; i < area; ++i) {
    if (rendered.alpha[i] >= kOpaque) usable.push_back(i);
  }
  const size_t count = std::min<size_t>(usable.size(), kPixelsAFrame);
  for (size_t k = 0; k < count; ++k) {
    const size_t i = usable[k * usable.size() / count];
    const Vector3d normal(rendered.normals[i], rendered.normals[area + i], rendered.normals[2 * area + i]);
    if (!(normal.norm() > 0.5)) continue;
    Vector3d light;
    for (int c = 0; c < 3; ++c) {
      light[c] = DecodePixel(rendered.image[area * c + i] / rendered.alpha[i], request_.encoding);
    }
    normals_.push_back(normal);
    light_.push_back(LuminanceOf(light));
    labels_.push_back(rendered.labels.empty() ? 0 : rendered.labels[i]);
  }
}

void FrameRelighter::Estimate() {
  MatrixX3d normals(Eigen::Index(normals_.size()), 3);
  for (size_t i = 0; i < normals_.size(); ++i) normals.row(Eigen::Index(i)) = normals_[i];
  fit_ = FitLighting(normals, light_, labels_);
  if (!fit_.summary.IsUsable() || !(fit_.summary.mean_shading > 0)) return;
  // In units of the mean shading, so that brightness is relative to that of the clip.
  old_light_ = GreyLight(fit_.coefficients / fit_.summary.mean_shading);
}

void FrameRelighter::Apply(MotionImage* image) const {
  BODYLOOM_CHECK(!image->normals.empty(), "relight: the image has no normals");
  RelightOptions options;
  options.encoding = request_.encoding;
  Relight(old_light_, request_.light, image->normals, image->alpha, options, image->image);
}

nlohmann::ordered_json FrameRelighter::Json() const {
  nlohmann::ordered_json json = {{"estimated", request_.estimate}};
  if (!request_.estimate) return json;
  const FitLightingSummary& s = fit_.summary;
  json["status"] = ToString(s.status);
  json["samples"] = s.samples;
  json["iterations"] = s.iterations;
  json["sigma"] = s.sigma;
  json["outlier_share"] = s.outlier_share;
  json["negative_share"] = s.negative_share;
  json["mean_shading"] = s.mean_shading;
  json["coefficients"] = std::vector<double>(fit_.coefficients.begin(), fit_.coefficients.end());
  json["albedo"] = fit_.albedo;
  return json;
}

}  // namespace bodyloom
