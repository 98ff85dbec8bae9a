// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/clothes_parser.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/person_label.h"
#include "render/image/palette.h"
#include "render/view/overlay.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

constexpr int kReach = 16;  ///< pixels around the mask

constexpr int kFirstClass = static_cast<int>(PersonLabel::kTop);
static_assert(static_cast<int>(PersonLabel::kShoes) - kFirstClass + 1 == kParserClasses);

ParserWeights CheckedParser(ParserWeights weights) {
  std::string why;
  BODYLOOM_CHECK(weights.IsValid(&why), "clothes parser: ", why);
  return weights;
}

/// The mask at a smaller image size: pixels at least half of which are inside.
std::vector<uint8_t> ResizedMask(std::span<const uint8_t> mask, const Image& image, int width, int height) {
  Image grey(image.width, image.height);
  for (size_t i = 0; i < mask.size(); ++i) std::fill_n(&grey.bgr[3 * i], 3, mask[i] != 0 ? uint8_t{255} : uint8_t{0});
  const Image small = Resized(grey, width, height);
  std::vector<uint8_t> result(static_cast<size_t>(width) * height);
  for (size_t i = 0; i < result.size(); ++i) result[i] = small.bgr[3 * i] > 127 ? 1 : 0;
  return result;
}

/// Scores of the network, interpolated bilinearly between the pixels of its input image.
class Answers {
 public:
  Answers(const PersonLayers& layers, std::vector<float> numbers) : layers_(layers), numbers_(std::move(numbers)) {}

  /// The class with the largest score at a position in the layers' image, pixels.
  [[nodiscard]] int ClassAt(double x, double y) const {
    const double u = std::clamp(x - layers_.x, 0.0, layers_.width - 1.0);
    const double v = std::clamp(y - layers_.y, 0.0, layers_.height - 1.0);
    const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
    const int u1 = std::min(u0 + 1, layers_.width - 1), v1 = std::min(v0 + 1, layers_.height - 1);
    const auto across = static_cast<float>(u - u0), down = static_cast<float>(v - v0);
    std::array<float, kParserClasses> answers{};
    for (int c = 0; c < kParserClasses; ++c) {
      const float* plane = numbers_.data() + c * layers_.pixels();
      const auto at = [&](int column, int row) { return plane[static_cast<size_t>(row) * layers_.width + column]; };
      answers[c] =
          std::lerp(std::lerp(at(u0, v0), at(u1, v0), across), std::lerp(at(u0, v1), at(u1, v1), across), down);
    }
    return static_cast<int>(std::max_element(answers.begin(), answers.end()) - answers.begin());
  }

 private:
  const PersonLayers& layers_;
  std::vector<float> numbers_;
};

}  // namespace

PersonLayers ParserLayers(const PersonPhoto& photo, int num_threads) {
  const Image& image = *photo.image;
  BODYLOOM_CHECK(photo.mask.size() == static_cast<size_t>(image.width) * image.height &&
                     image.width == photo.camera.width && image.height == photo.camera.height,
                 "clothes parser: an image of ", image.width, "x", image.height, " with a mask of ", photo.mask.size(),
                 " pixels and a camera of ", photo.camera.width, "x", photo.camera.height);
  PersonLayers layers = BoxAround(image.width, image.height, photo.mask, kReach);
  const size_t pixels = layers.pixels();
  layers.planes.assign(PersonPlane::kNormal * pixels, 0);
  if (pixels == 0) return layers;
  ForEachPixel(layers, image.width, image.height, [&](int x, int y, size_t i) {
    if (photo.mask[static_cast<size_t>(y) * image.width + x] == 0) return;
    layers.planes[PersonPlane::kAlpha * pixels + i] = 1;
    for (size_t c = 0; c < 3; ++c) {
      layers.planes[(PersonPlane::kColour + c) * pixels + i] = static_cast<float>(image.pixel(x, y)[2 - c]) / 255;
    }
  });
  SurfacePlanes(*photo.body, *photo.rest_vertices, num_threads).Draw(*photo.vertices_in_camera, photo.camera, &layers);
  return layers;
}

ClothesParser::ClothesParser(ParserWeights weights)
    : pixels_per_metre_(weights.pixels_per_metre), network_(CheckedParser(std::move(weights)).network, kParserPlanes) {}

std::vector<uint8_t> ClothesParser::Labels(const PersonPhoto& photo, int num_threads) {
  const double factor =
      ImageUnetScale(PixelsPerMetre(photo.camera, photo.vertices_in_camera->col(2).mean()), pixels_per_metre_);
  Image smaller;
  std::vector<uint8_t> smaller_mask;
  PersonPhoto at_known_size = photo;
  if (factor < 1) {
    at_known_size.camera = ScaledCamera(photo.camera, factor);
    smaller = Resized(*photo.image, at_known_size.camera.width, at_known_size.camera.height);
    smaller_mask = ResizedMask(photo.mask, *photo.image, smaller.width, smaller.height);
    at_known_size.image = &smaller, at_known_size.mask = smaller_mask;
  }
  const PersonLayers layers = ParserLayers(at_known_size, num_threads);
  std::vector<uint8_t> labels(photo.mask.size(), 0);
  if (layers.pixels() == 0) return labels;
  const Answers answers(layers, network_.Run(layers.width, layers.height, layers.planes));
  for (int y = 0; y < photo.image->height; ++y) {
    for (int x = 0; x < photo.image->width; ++x) {
      const size_t i = static_cast<size_t>(y) * photo.image->width + x;
      if (photo.mask[i] == 0) continue;
      const int of_class = answers.ClassAt(factor * (x + 0.5) - 0.5, factor * (y + 0.5) - 0.5);
      labels[i] = static_cast<uint8_t>(kFirstClass + of_class);
    }
  }
  RelabelByColour(*photo.image, labels);
  return labels;
}

std::vector<uint8_t> ClothesParser::Labels(const Image& image, std::span<const uint8_t> mask, const BodyModel& body,
                                           const Track& track, const Camera& camera, int num_threads) {
  const MatrixX3d rest = ShapeVertices(body, track.motion.betas), vertices = TrackVertices(body, track, 0);
  return Labels({&image, mask, &body, &rest, &vertices, camera}, num_threads);
}

namespace {

constexpr float kLightnessWeight = 0.5F;
constexpr float kRatio = 0.5F;
constexpr size_t kFewestPixels = 50;

/// (L/2, a, b) of some pixels of the image.
std::vector<ChannelTriple> LabOf(const Image& image, const std::vector<size_t>& pixels) {
  cv::Mat colours(1, static_cast<int>(pixels.size()), CV_32FC3);
  for (size_t k = 0; k < pixels.size(); ++k) {
    const uint8_t* bgr = &image.bgr[3 * pixels[k]];
    colours.at<cv::Vec3f>(static_cast<int>(k)) = cv::Vec3f(bgr[0], bgr[1], bgr[2]) / 255;
  }
  cv::cvtColor(colours, colours, cv::COLOR_BGR2Lab);
  std::vector<ChannelTriple> lab;
  lab.reserve(pixels.size());
  for (const cv::Vec3f& colour : cv::Mat_<cv::Vec3f>(colours)) {
    lab.push_back({colour[0] * kLightnessWeight, colour[1], colour[2]});
  }
  return lab;
}

float Distance(const ChannelTriple& a, const ChannelTriple& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

void RelabelByColour(const Image& image, std::span<uint8_t> labels) {
  BODYLOOM_CHECK(3 * labels.size() == image.bgr.size(), "labels by colour: ", labels.size(), " labels for ",
                 image.width, "x", image.height, " pixels");
  std::vector<size_t> pixels;
  for (size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] == 0 || labels[i] >= kNumPersonLabels) continue;
    pixels.push_back(i);
  }
  if (pixels.empty()) return;
  const std::vector<ChannelTriple> colours = LabOf(image, pixels);
  std::array<std::vector<ChannelTriple>, kNumPersonLabels> of_label;
  for (size_t k = 0; k < pixels.size(); ++k) of_label[labels[pixels[k]]].push_back(colours[k]);
  const auto median_of = [&](PersonLabel label) {
    return MedianColourOfMany(of_label[static_cast<size_t>(label)], kFewestPixels);
  };
  const std::optional<ChannelTriple> face = median_of(PersonLabel::kFace);
  if (!face) return;
  const std::array<PersonLabel, 2> kinds = {PersonLabel::kTop, PersonLabel::kBottom};
  const std::array<std::optional<ChannelTriple>, 2> worn = {median_of(kinds[0]), median_of(kinds[1])};
  for (size_t k = 0; k < pixels.size(); ++k) {
    uint8_t& label = labels[pixels[k]];
    const float to_face = Distance(colours[k], *face);
    float nearest = kRatio * to_face;
    const bool skin = label == static_cast<uint8_t>(PersonLabel::kSkin);
    for (size_t j = 0; j < 2; ++j) {
      if (!worn[j]) continue;
      const float to_worn = Distance(colours[k], *worn[j]);
      if (skin && to_worn < nearest) {
        nearest = to_worn;
        label = static_cast<uint8_t>(kinds[j]);
      } else if (!skin && label == static_cast<uint8_t>(kinds[j]) && to_face < kRatio * to_worn) {
        label = static_cast<uint8_t>(PersonLabel::kSkin);
        break;
      }
    }
  }
}

SurfacePlanes::SurfacePlanes(const BodyModel& body, const MatrixX3d& rest_vertices, int num_threads)
    : body_(&body), threads_(num_threads) {
  places_.reserve(static_cast<size_t>(rest_vertices.size()));
  for (Eigen::Index v = 0; v < rest_vertices.rows(); ++v) {
    for (int c = 0; c < 3; ++c) places_.push_back(static_cast<float>(rest_vertices(v, c)));
  }
}

void SurfacePlanes::Draw(const MatrixX3d& vertices, const Camera& camera, PersonLayers* layers) {
  const size_t pixels = layers->pixels();
  layers->planes.resize(PersonPlane::kNormal * pixels);
  layers->planes.resize(PersonPlane::kCount * pixels, 0);
  VisibilityOptions visibility;
  visibility.cull_back_faces = true;
  visibility.num_threads = threads_;
  buffer_.Render(vertices, body_->data().faces, camera, visibility);
  ResolveRequest request;
  request.num_threads = threads_;
  request.normal = true;
  request.vertex_normals = &normals_.Compute(vertices, body_->data().faces);
  request.vertex_attributes = {{places_, 3}};
  ResolvePixels(buffer_, *body_, vertices, camera, request, &pixels_);
  const auto plane = [&](int p) { return layers->planes.begin() + static_cast<std::ptrdiff_t>(p * pixels); };
  ForEachPixel(*layers, camera.width, camera.height, [&](int x, int y, size_t i) {
    if (plane(PersonPlane::kAlpha)[i] == 0 || buffer_.FaceAt(x, y) < 0) return;
    const size_t at = buffer_.box().IndexOf(x, y);
    for (int c = 0; c < 3; ++c) {
      plane(PersonPlane::kNormal + c)[i] = pixels_.normal[3 * at + c];
      plane(PersonPlane::kPlace + c)[i] = pixels_.vertex_attributes[0][3 * at + c];
    }
  });
}

}  // namespace bodyloom
